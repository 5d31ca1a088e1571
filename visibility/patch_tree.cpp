#include "visibility/patch_tree.hpp"

#include "visibility/box_tree.hpp"

namespace fluxel {
namespace {

BoxTree::Point point(const glm::dvec3& x) { return {x.x, x.y, x.z}; }
glm::dvec3 to_vector(const BoxTree::Point& x) { return {x[0], x[1], x[2]}; }

}  // namespace

PatchTree::PatchTree(const Scene& scene) : patches_(scene.patches) {
  std::vector<BoxTree::Box> boxes;
  boxes.reserve(patches_.size());
  for (const Patch& patch : patches_) {
    const Box box = bounds(corners(patch.outline));
    boxes.push_back({point(box.low), point(box.high)});
  }
  const BoxTree tree(boxes);
  ids_.reserve(tree.order.size());
  for (const std::uint32_t item : tree.order) ids_.push_back(PatchId{item});
  nodes_.reserve(tree.nodes.size());
  for (const BoxTree::Node& node : tree.nodes)
    nodes_.push_back({{to_vector(node.box.low), to_vector(node.box.high)}, node.first, node.count});
}

bool PatchTree::candidates(const Shaft& shaft, double epsilon, std::vector<PatchId>& out,
                           std::size_t most) const {
  std::size_t found = 0;
  return !search([&](const Box& box) { return shaft.may_meet(box, epsilon); },
                 [&](PatchId id) {
                   if (!may_meet(shaft, epsilon, id)) return false;
                   if (++found > most) return true;
                   out.push_back(id);
                   return false;
                 });
}

bool PatchTree::filter(const Shaft& shaft, double epsilon, std::span<const PatchId> among,
                       std::vector<PatchId>& out, std::size_t most) const {
  std::size_t found = 0;
  for (const PatchId id : among) {
    if (!may_meet(shaft, epsilon, id)) continue;
    if (++found > most) return false;
    out.push_back(id);
  }
  return true;
}

}  // namespace fluxel

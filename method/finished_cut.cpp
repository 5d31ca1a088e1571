#include "method/finished_cut.hpp"

#include <algorithm>
#include <cmath>

#include "core/sampling.hpp"

namespace fluxel {

FinishedCut::FinishedCut(const NodeTree& tree, const CutLight& light)
    : tree_(tree), light_(light), pieces_(tree.scene()) {
  double sum = 0;
  for (const double power : light.reflected_powers()) ends_.push_back(sum += power);
}

NodeId FinishedCut::leaf_at(PatchId patch, bool front, const glm::dvec3& point) const {
  return tree_.leaf_below(tree_.face(pieces_.find(patch, point), front), point);
}

Rgb FinishedCut::reflected(PatchId patch, bool front, const glm::dvec3& point) const {
  const NodeId leaf = leaf_at(patch, front, point);
  return leaf == kNoNode ? Rgb(0) : light_.reflected(leaf);
}

std::optional<DrawnPoint> FinishedCut::draw(double u, double v) const {
  if (ends_.empty() || !(ends_.back() > 0)) return std::nullopt;
  const double at = u * ends_.back();
  const auto row = std::min(static_cast<std::size_t>(std::ranges::upper_bound(ends_, at) - ends_.begin()),
                            ends_.size() - 1);
  const double start = row > 0 ? ends_[row - 1] : 0;
  // What the choices of the node and of its face have left of u is uniform again.
  double rest = ends_[row] > start
                    ? std::clamp((at - start) / (ends_[row] - start), 0.0, std::nextafter(1.0, 0.0))
                    : 0.5;
  const NodeId face = tree_.random_face(light_.cut().nodes()[row], rest);
  const Node& node = tree_[face];
  return DrawnPoint{surface_point(tree_.outline(face), rest, v), tree_.scene().pieces[node.piece].patch,
                    node.front};
}

double FinishedCut::density(PatchId patch, bool front, const glm::dvec3& point) const {
  const NodeId leaf = leaf_at(patch, front, point);
  if (leaf == kNoNode || ends_.empty() || !(ends_.back() > 0)) return 0;
  const std::uint32_t row = light_.cut().row_of(tree_, leaf);
  const double power = ends_[row] - (row > 0 ? ends_[row - 1] : 0);
  return power / (ends_.back() * tree_[light_.cut().nodes()[row]].shape.area);
}

}  // namespace fluxel

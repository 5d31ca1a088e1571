#include "visibility/cuda/wide_tree.hpp"

#include <algorithm>
#include <cmath>

#include "visibility/box_tree.hpp"
#include "visibility/cuda/device.hpp"
#include "visibility/cuda/shaft.hpp"
#include "visibility/cuda/tree_walk.hpp"

namespace fluxel::cuda {

namespace {

static_assert(BoxTree::kLeafSize == kMaxInLeaf);

BoxTree::Box bounds(const ExactPatch& patch, double margin) {
  BoxTree::Box box{};
  for (std::uint32_t c = 0; c < patch.corners; ++c) {
    const BoxTree::Point corner{patch.corner[c].x, patch.corner[c].y, patch.corner[c].z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = c == 0 ? corner[axis] : std::min(box.low[axis], corner[axis]);
      box.high[axis] = c == 0 ? corner[axis] : std::max(box.high[axis], corner[axis]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] -= margin;
    box.high[axis] += margin;
  }
  return box;
}

double surface(const BoxTree::Box& box) {
  const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
  return x * y + y * z + z * x;
}

float at_most(double value) {
  const auto near = static_cast<float>(value);
  return static_cast<double>(near) > value ? std::nextafter(near, -INFINITY) : near;
}

/// Origin and exponents of a node: bytes from 0 to 255 reach over all of the box, and one to spare.
void set_grid(const BoxTree::Box& box, WideNode& node) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.origin[axis] = at_most(box.low[axis]);
    const double reach = box.high[axis] - static_cast<double>(node.origin[axis]);
    node.exponent[axis] =
        static_cast<std::int8_t>(std::clamp(std::ilogb(std::max(reach, 1e-30) / 254) + 1, -120, 120));
  }
}

/// The child's box in the node's grid, rounded outwards, as child_box will read it.
void set_box(const BoxTree::Box& box, std::size_t child, WideNode& node) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double unit = std::ldexp(1.0, node.exponent[axis]), origin = node.origin[axis];
    const double low = std::floor((box.low[axis] - origin) / unit);
    const double high = std::ceil((box.high[axis] - origin) / unit);
    node.low[axis][child] = static_cast<std::uint8_t>(std::clamp(low, 0.0, 255.0));
    node.high[axis][child] = static_cast<std::uint8_t>(std::clamp(high, 0.0, 255.0));
  }
}

struct Builder {
  const BoxTree& binary;
  std::vector<WideNode>& nodes;
  std::vector<std::uint32_t>& order;

  /// The nodes that stand side by side under `root`.
  [[nodiscard]] std::vector<std::uint32_t> children_of(std::uint32_t root) const {
    std::vector<std::uint32_t> children{root};
    while (children.size() < 8) {
      std::size_t widest = children.size();
      for (std::size_t k = 0; k < children.size(); ++k) {
        const BoxTree::Node& node = binary.nodes[children[k]];
        if (node.count == 0 &&
            (widest == children.size() || surface(node.box) > surface(binary.nodes[children[widest]].box)))
          widest = k;
      }
      if (widest == children.size()) break;
      const std::uint32_t opened = children[widest];
      children[widest] = binary.nodes[opened].first;
      children.push_back(binary.nodes[opened].first + 1);
    }
    return children;
  }

  void build(std::size_t place, std::uint32_t root, std::uint32_t level) {
    if (level > kMaxLevels) throw DeviceError("the tree of patches has too many levels for a device");
    const std::vector<std::uint32_t> children = children_of(root);
    WideNode node{};
    set_grid(binary.nodes[root].box, node);
    node.first_child = static_cast<std::uint32_t>(nodes.size());
    node.first_patch = static_cast<std::uint32_t>(order.size());
    std::uint32_t inner = 0;
    for (std::size_t k = 0; k < children.size(); ++k) {
      const BoxTree::Node& child = binary.nodes[children[k]];
      set_box(child.box, k, node);
      if (child.count == 0) {
        node.inner = static_cast<std::uint8_t>(node.inner | 1u << k);
        ++inner;
      } else {
        node.patches[k] = static_cast<std::uint8_t>(child.count << 5 | (order.size() - node.first_patch));
        for (std::uint32_t i = child.first; i < child.first + child.count; ++i)
          order.push_back(binary.order[i]);
      }
    }
    nodes[place] = node;
    nodes.resize(nodes.size() + inner);
    for (std::uint32_t k = 0; k < children.size(); ++k)
      if (is_node(node, k)) build(child_node(node, k), children[k], level + 1);
  }
};

}  // namespace

WideTree::WideTree(const std::vector<ExactPatch>& patches, float extent) {
  if (patches.empty()) return;
  const double margin = static_cast<double>(kBoxMargin) * static_cast<double>(extent);
  std::vector<BoxTree::Box> boxes;
  boxes.reserve(patches.size());
  for (const ExactPatch& patch : patches) boxes.push_back(bounds(patch, margin));
  const BoxTree binary(boxes);
  nodes.resize(1);
  order.reserve(patches.size());
  Builder{binary, nodes, order}.build(0, 0, 1);
}

}  // namespace fluxel::cuda

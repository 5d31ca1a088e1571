#include "subdivision/coarsen.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "subdivision/add_element.hpp"
#include "subdivision/bisection.hpp"

namespace fluxel {

namespace {

/// What stands below a node of a piece's tree. In an array of all nodes, each before its left and that before
/// its right subtree, the left child follows its parent and the right one 2 * leaves of the left - 1 places
/// further on.
struct Node {
  std::uint32_t leaves = 1;
  std::uint32_t pixels = 0;  ///< that these own
};

/// The leaves of one piece, and the criterion.
class PieceTree {
 public:
  PieceTree(const Scene& scene, const Piece& piece, std::span<const Element> leaves,
            std::span<const std::byte> levels, int k, double max_edge)
      : scene_(scene), piece_(piece), leaves_(leaves), levels_(levels), k_(k), max_edge_(max_edge) {}

  /// Appends its coarse elements; `first` is the piece's first leaf. Returns the leaf behind its last.
  std::uint32_t merge(std::uint32_t first, CoarseMesh& coarse) {
    nodes_.clear();
    build(0, first);
    add(piece_.outline, 0, first, coarse);
    return first + nodes_.front().leaves;
  }

 private:
  /// Every step halves the area, so rounding is far from the next step.
  [[nodiscard]] int depth_of(std::uint32_t leaf) const {
    if (leaf >= leaves_.size() || leaves_[leaf].patch != piece_.patch || !(leaves_[leaf].area > 0))
      throw std::logic_error("the elements end before their piece does");
    return static_cast<int>(
        std::lround(std::log2(area(piece_.outline) / static_cast<double>(leaves_[leaf].area))));
  }

  /// The subtree of a node at that depth, whose leaves begin with `first`.
  Node build(int depth, std::uint32_t first) {
    const int deep = depth_of(first);
    if (deep < depth) throw std::logic_error("an element is larger than its place in the piece");
    const std::size_t place = nodes_.size();
    nodes_.emplace_back();
    Node node;
    if (deep == depth) {
      node.pixels = std::to_integer<int>(levels_[first]) > k_ ? 1 : 0;
    } else {
      const Node left = build(depth + 1, first), right = build(depth + 1, first + left.leaves);
      node = {left.leaves + right.leaves, left.pixels + right.pixels};
    }
    return nodes_[place] = node;
  }

  void add(const Outline3& outline, std::size_t place, std::uint32_t first, CoarseMesh& coarse) const {
    const Node& node = nodes_[place];
    if (node.leaves > 1 && (node.pixels > 1 || is_longer(longest_edge(outline), max_edge_))) {
      const auto [left, right] = bisect(outline);
      const std::uint32_t of_left = nodes_[place + 1].leaves;
      add(left, place + 1, first, coarse);
      add(right, place + 2 * of_left, first + of_left, coarse);
      return;
    }
    add_element(scene_, piece_.patch, outline, coarse.mesh);
    coarse.first.push_back(first);
    coarse.pixel_levels.push_back(std::ranges::max(levels_.subspan(first, node.leaves)));
  }

  const Scene& scene_;
  const Piece& piece_;
  std::span<const Element> leaves_;
  std::span<const std::byte> levels_;
  int k_;
  double max_edge_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<std::byte> pixel_levels(const Raster& raster, std::size_t elements) {
  std::vector<std::byte> levels(elements);
  const auto width = static_cast<std::size_t>(raster.width);
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel) {
    if (raster.element[pixel] == kNoElement) continue;
    std::byte& level = levels[index(raster.element[pixel])];
    level = std::max(level, static_cast<std::byte>(1 + std::countr_zero(pixel % width | pixel / width)));
  }
  return levels;
}

CoarseMesh coarsen(const Scene& scene, std::span<const Element> fine, std::span<const std::byte> fine_levels,
                   int k, double max_edge) {
  CoarseMesh coarse;
  std::uint32_t next = 0;
  for (const Piece& piece : scene.pieces)
    next = PieceTree(scene, piece, fine, fine_levels, k, max_edge).merge(next, coarse);
  if (next != fine.size()) throw std::logic_error("there are more elements than the pieces have");
  coarse.first.push_back(next);
  return coarse;
}

}  // namespace fluxel

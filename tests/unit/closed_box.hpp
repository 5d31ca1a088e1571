#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "core/second_moments.hpp"
#include "formfactor/pair_rule.hpp"
#include "solver/pair_kernel.hpp"
#include "visibility/tile.hpp"

namespace fluxel::test_scenes {

/// The inside of a box, convex: an element sees all but those of its own face, and the factors to them add up
/// to 1. Every face has `along` x `along` elements; a multiple of 8 makes whole tiles of each face.
class ClosedBox {
 public:
  explicit ClosedBox(std::size_t along) : of_face_(along * along) {
    elements.reserve(6 * of_face_);
    for (std::size_t face = 0; face < 6; ++face) add_face(face, along);
  }

  std::vector<Element> elements;

  [[nodiscard]] std::size_t face_of(std::size_t element) const { return element / of_face_; }

  /// sum_j F_ij x_j in double precision, after the plain statement of the rule.
  [[nodiscard]] double plain_row(PairRule rule, std::size_t i, const std::vector<FlatShape>& shapes,
                                 const std::vector<float>& x) const {
    double sum = 0;
    for (std::size_t j = 0; j < shapes.size(); ++j)
      if (face_of(j) != face_of(i))
        sum += pair_form_factor(rule, shapes[i], shapes[j]) * static_cast<double>(x[j]);
    return sum;
  }

  /// The same by the kernel, a block of tiles after another, as a solve does it.
  [[nodiscard]] double kernel_row(PairRule rule, std::size_t i, const PairColumns& columns,
                                  const ColumnPower& power) const {
    TileBits all;
    all.fill(~std::uint64_t{0});
    std::array<RowIrradiance<1>, 1> sum{};
    for (std::size_t first = 0; first < columns.tiles.size(); first += kBlockTiles) {
      std::vector<SeenTile> seen;
      for (std::size_t tile = first; tile < std::min(first + kBlockTiles, columns.tiles.size()); ++tile)
        if (face_of(tile * kTileSize) != face_of(i)) seen.push_back({tile, &all});
      gather_block({rule, false, columns, power, i, seen}, sum);
    }
    return sum[0][0][0];
  }

 private:
  std::size_t of_face_;

  void add_face(std::size_t face, std::size_t along) {
    constexpr std::array<double, 3> kEdges{3, 2.4, 1.7};
    const std::size_t axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    glm::dvec3 normal(0), edge_u(0), edge_v(0), corner(0);
    const auto at = [](std::size_t k) { return static_cast<int>(k); };
    normal[at(axis)] = face % 2 == 0 ? 1 : -1;
    corner[at(axis)] = face % 2 == 0 ? 0 : kEdges[axis];
    edge_u[at(u)] = kEdges[u] / static_cast<double>(along);
    edge_v[at(v)] = kEdges[v] / static_cast<double>(along);
    Outline<glm::dvec3> outline;
    outline.corners = 4;
    outline.corner = {corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v};
    const SecondMoments moments = second_moments(outline);
    Element element;
    element.normal = glm::vec3(normal);
    element.area = static_cast<float>(glm::length(edge_u) * glm::length(edge_v));
    element.minor_variance = static_cast<float>(moments.minor_variance);
    element.elongation = glm::vec3(moments.elongation);
    element.sides = kFront;
    for (std::size_t k = 0; k < of_face_; ++k) {
      const auto row = static_cast<double>(k / along), column = static_cast<double>(k % along);
      element.centroid = glm::vec3(corner + (row + 0.5) * edge_u + (column + 0.5) * edge_v);
      elements.push_back(element);
    }
  }
};

[[nodiscard]] inline std::vector<FlatShape> flat_shapes(const std::vector<Element>& elements) {
  std::vector<FlatShape> shapes;
  shapes.reserve(elements.size());
  for (const Element& element : elements) shapes.push_back(flat_shape(element));
  return shapes;
}

/// The power of fronts with these values, one channel.
[[nodiscard]] inline ColumnPower power_of(const PairColumns& columns, const std::vector<float>& x) {
  ColumnPower power(columns.tiles.size(), 1, 1);
  for (std::size_t j = 0; j < x.size(); ++j)
    power.of(j / kTileSize, 0, 0)[j % kTileSize] = static_cast<float>(
        static_cast<double>(columns.area[j]) * std::numbers::inv_pi * static_cast<double>(x[j]));
  return power;
}

}  // namespace fluxel::test_scenes

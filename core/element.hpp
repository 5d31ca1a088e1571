#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/ids.hpp"

namespace fluxel {

/// Bits of a side mask: the sides of an element that are unknowns.
inline constexpr std::uint8_t kFront = 1;
inline constexpr std::uint8_t kBack = 2;

/// A leaf of a patch's bisection tree. Lengths in the scene's recentred metres, single precision as the rays.
struct Element {
  glm::vec3 centroid{0};
  float area = 0;  ///< [m2]
  glm::vec3 normal{0};
  PatchId patch = kNoPatch;
  MaterialId material{};
  std::uint32_t sides = 0;   ///< mask of kFront and kBack
  glm::vec3 elongation{0};   ///< [m], and
  float minor_variance = 0;  ///< [m2]: see SecondMoments
};

/// The outline of an element or of a piece of a patch: a triangle or a parallelogram, counter-clockwise.
template <class Vec>
struct Outline {
  std::array<Vec, 4> corner{};
  std::uint32_t corners = 0;  ///< 3 or 4
};

/// About the opposite normal.
template <class Vec>
[[nodiscard]] Outline<Vec> reversed(Outline<Vec> outline) {
  std::reverse(outline.corner.begin(), outline.corner.begin() + outline.corners);
  return outline;
}

/// The outline in double precision.
[[nodiscard]] inline Outline<glm::dvec3> widen(const Outline<glm::vec3>& outline) {
  Outline<glm::dvec3> wide;
  wide.corners = outline.corners;
  for (std::size_t k = 0; k < outline.corners; ++k) wide.corner[k] = glm::dvec3(outline.corner[k]);
  return wide;
}

/// All elements in the order of the unknowns, and their outlines in the same order.
struct ElementMesh {
  std::vector<Element> elements;
  std::vector<Outline<glm::vec3>> outlines;
};

/// The same for those who read it, wherever it is held; what holds it must outlive this.
struct ElementView {
  std::span<const Element> elements;
  std::span<const Outline<glm::vec3>> outlines;

  ElementView() = default;
  ElementView(std::span<const Element> of_elements, std::span<const Outline<glm::vec3>> of_outlines)
      : elements(of_elements), outlines(of_outlines) {}
  ElementView(const ElementMesh& mesh) : ElementView(mesh.elements, mesh.outlines) {}
};

}  // namespace fluxel

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "core/raster.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// For each element, one more than the largest k for which it owns a pixel whose column and row are multiples
/// of 2^k; 0 where it owns no pixel. An element that camera subdivision has made owns at most one.
[[nodiscard]] std::vector<std::byte> pixel_levels(const Raster& raster, std::size_t elements);

/// A mesh whose elements are unions of consecutive elements of a finer one.
struct CoarseMesh {
  ElementMesh mesh;
  /// Of each element its first fine one, and the number of fine elements at the end.
  std::vector<std::uint32_t> first;
  std::vector<std::byte> pixel_levels;  ///< as those of the fine elements

  [[nodiscard]] std::size_t size() const { return mesh.elements.size(); }
};

/// The mesh that subdivision makes of every 2^k-th column and row of the camera's pixels and edges of at most
/// `max_edge` [m], where `fine` is that of more pixels and shorter edges: all elements of the scene, in the
/// order of the unknowns, with their pixel levels (all 0: no camera). Elements are merged up their bisection
/// trees, which are built again from the pieces, so that an element that stays is the same, byte by byte; a
/// leaf's depth follows from its area. Throws std::logic_error where the elements are not of these trees.
[[nodiscard]] CoarseMesh coarsen(const Scene& scene, std::span<const Element> fine,
                                 std::span<const std::byte> fine_levels, int k, double max_edge);

}  // namespace fluxel

#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/element.hpp"

namespace fluxel {

/// Outlines as files hold them: corners by number. Faces stand in the order of the outlines, corners in
/// theirs but for where they begin.
struct IndexedMesh {
  struct Face {
    std::array<std::uint32_t, 4> vertex{};
    std::uint32_t corners = 0;  ///< 3 or 4
  };
  std::vector<glm::dvec3> vertices;
  std::vector<Face> faces;
};

/// Corners at equal coordinates are one vertex, except those of a face that would make the mesh non-manifold:
/// it has its own.
[[nodiscard]] IndexedMesh indexed_mesh(std::span<const Outline<glm::dvec3>> outlines);

}  // namespace fluxel

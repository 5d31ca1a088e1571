#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/rgb.hpp"
#include "scene/readers/gltf_accessor.hpp"
#include "scene/readers/gltf_file.hpp"
#include "scene/readers/gltf_nodes.hpp"

namespace fluxel {

/// The triangles of a primitive of a mesh.
struct GltfTriangles {
  std::size_t mesh = 0, primitive = 0;
  std::optional<std::size_t> material;
  GltfAccessor positions;
  std::vector<std::array<std::size_t, 3>> corners;  ///< positions, counter-clockwise seen from the front
  std::vector<Rgb> rho;                             ///< of each, where the material has an image

  [[nodiscard]] std::string where() const;  ///< JSON path
};

/// What the nodes need of the meshes.
struct GltfMeshes {
  std::vector<std::vector<GltfTriangles>> meshes;  ///< of each mesh; none where no node has it
  std::vector<std::size_t> copies;                 ///< of each mesh: nodes that have it
  std::size_t triangles = 0;                       ///< of all nodes together
  std::size_t points_and_lines = 0;                ///< primitives that are left out
};

/// Reads lists, strips and fans of triangles, with indices or without (glTF 2.0, section 3.7.2.1).
/// `file_bytes` bounds how many triangles copies of meshes may make. Throws InputError with the JSON path.
[[nodiscard]] GltfMeshes read_gltf_meshes(const GltfFile& gltf, const std::vector<GltfNode>& nodes,
                                          std::size_t file_bytes);

}  // namespace fluxel

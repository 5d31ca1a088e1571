#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/element.hpp"
#include "core/rgb.hpp"

namespace fluxel {

/// A mesh with light of its own, apart from the elements of the solution that it is of. Lengths in recentred
/// metres; an unknown is a side of a face, in the order of make_unknowns.
struct BakedMesh {
  ElementMesh mesh;  ///< its faces, as the elements of --subdivision uniform are

  /// Irradiance of each unknown at the face's centroid, and its standard error by rays [W/m2]; empty where no
  /// file has them.
  std::vector<Rgb> H, noise_of_H;

  /// Vertices, those of either side of each piece of a patch apart, with their irradiance [W/m2]; empty where
  /// no file has them.
  std::vector<glm::vec3> vertices;
  std::vector<Rgb> H_of_vertices;
  /// Of each unknown the vertices at the corners of the face's outline.
  std::vector<std::array<std::uint32_t, 4>> corners;

  double noise = 0;  ///< of radiosity by rays, root mean square over its mean, as some faces or vertices tell
};

}  // namespace fluxel

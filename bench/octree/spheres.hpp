#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "octree/octree_view.hpp"
#include "scene/scene.hpp"

namespace fluxel::bench {

/// Spheres as records or photons have them: centres evenly over the surfaces of a scene, of one radius, so
/// that about `overlap` of them hold a point of a surface.
struct SphereSet {
  std::vector<Sphere> spheres;
  double radius = 0;  ///< [m]
};
[[nodiscard]] SphereSet spheres_on(const Scene& scene, std::size_t count, double overlap);

/// Points of the surfaces, evenly.
[[nodiscard]] std::vector<glm::dvec3> points_on(const Scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace fluxel::bench

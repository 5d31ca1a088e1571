#include <limits>

#include "scene/contact_pairs.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

float surface_epsilon(const Scene& scene) {
  // What counts as one plane when patches are cut must be one plane for rays too: else a patch that has taken
  // another's area may look out from behind it.
  return static_cast<float>(contact_tolerance(scene) +
                            4 * scene.extent * std::numeric_limits<float>::epsilon());
}

double least_gap(const Scene& scene) {
  // The places of two centroids, each in three coordinates, and their normals.
  const double rounding = 4 * scene.extent * static_cast<double>(std::numeric_limits<float>::epsilon());
  return static_cast<double>(kFacingHeights * surface_epsilon(scene)) + rounding;
}

}  // namespace fluxel

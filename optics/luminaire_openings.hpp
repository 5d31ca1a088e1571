#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/rgb.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Luminaires' openings as rays meet them, with the light of LuminaireLight: a point of an opening of area A
/// has the radiance I(C, gamma) / (A cos) to either side. It grows without bound towards the opening's plane
/// where the table has light there, and is integrable. Luminaires that are points or lines are not met.
/// Queries may run from many threads at once.
class LuminaireOpenings {
 public:
  /// The ray scene, and its scene, must outlive this.
  explicit LuminaireOpenings(const RayScene& ray_scene);

  [[nodiscard]] bool empty() const { return openings_.empty(); }

  /// The radiance [W/(m2 sr)] that comes back along a ray in a unit direction from all openings on it, the
  /// first surface on it being at the distance `end` [m]: openings hide nothing, and light leaves those that
  /// lie on a surface.
  [[nodiscard]] Rgb radiance(const Ray& ray, double end) const;

 private:
  struct Opening {
    const Luminaire* luminaire;
    const IntensityTable* table;
    glm::dvec3 across;  ///< unit: C = 90 degrees
    double area;        ///< [m2]
  };

  std::vector<Opening> openings_;
  double lift_;
};

}  // namespace fluxel

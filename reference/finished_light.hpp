#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "core/ids.hpp"
#include "core/rgb.hpp"

namespace fluxel {

/// A point of a side that was drawn.
struct DrawnPoint {
  glm::dvec3 position{0};  ///< [m, recentred]
  PatchId patch = kNoPatch;
  bool front = true;
};

/// The light of a finished solution at points of the surfaces, from any number of threads.
class FinishedLight {
 public:
  virtual ~FinishedLight() = default;
  /// The radiosity [W/m2] that a side reflects, without its emission, at a point [m, recentred].
  [[nodiscard]] virtual Rgb reflected(PatchId patch, bool front, const glm::dvec3& point) const = 0;

  /// A point from the unit square, mostly where much is reflected; none where nothing is.
  [[nodiscard]] virtual std::optional<DrawnPoint> draw(double /*u*/, double /*v*/) const { return {}; }
  /// The density [1/m2] with which `draw` finds a point; 0 everywhere where it finds none.
  [[nodiscard]] virtual double density(PatchId /*patch*/, bool /*front*/, const glm::dvec3& /*point*/) const {
    return 0;
  }
};

}  // namespace fluxel

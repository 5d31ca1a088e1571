#pragma once

#include <glm/vec3.hpp>

#include "core/ids.hpp"
#include "core/rgb.hpp"

namespace fluxel {

/// The light of a finished solution at points of the surfaces, from any number of threads.
class FinishedLight {
 public:
  virtual ~FinishedLight() = default;
  /// The radiosity [W/m2] that a side reflects, without its emission, at a point [m, recentred].
  [[nodiscard]] virtual Rgb reflected(PatchId patch, bool front, const glm::dvec3& point) const = 0;
};

}  // namespace fluxel

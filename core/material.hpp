#pragma once

#include <string>

#include "core/rgb.hpp"

namespace fluxel {

/// Which sides of a surface send and receive: the side of its normal, or both (emission stays on the front).
enum class Sides { one, two };

/// A diffuse (Lambertian) surface.
struct Material {
  std::string name;
  Rgb rho{0.5};  ///< reflectance, linear, 0..1
  Rgb E{0.0};    ///< emitted exitance of the front [W/m2] or [lm/m2]
  Sides sides = Sides::one;

  [[nodiscard]] bool emits() const { return E.r > 0 || E.g > 0 || E.b > 0; }
};

}  // namespace fluxel

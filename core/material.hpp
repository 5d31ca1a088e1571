#pragma once

#include <optional>
#include <string>

#include "core/rgb.hpp"
#include "core/thermal.hpp"

namespace fluxel {

/// Which sides of a surface send and receive: the side of its normal, or both. Light is emitted by the front
/// alone, heat by every side that sends.
enum class Sides { one, two };

/// A diffuse (Lambertian) surface.
struct Material {
  std::string name;
  Rgb rho{0.5};  ///< reflectance, linear, 0..1
  Rgb E{0.0};    ///< emitted exitance of the front [W/m2] or [lm/m2]; of heat below 0 where a flux is drawn
  Sides sides = Sides::one;
  /// Of a thermal run: what rho and E come from, with convection at first_irradiance.
  std::optional<ThermalSurface> thermal = std::nullopt;

  [[nodiscard]] bool emits() const { return E != Rgb(0); }
  /// The exitance of the back: that of the front for heat, none for light.
  [[nodiscard]] Rgb back_exitance() const { return thermal ? E : Rgb(0); }
  /// Whether rho and E are but a beginning: those of a side follow from its temperature.
  [[nodiscard]] bool has_convection() const { return thermal && thermal->has_convection(); }
};

}  // namespace fluxel

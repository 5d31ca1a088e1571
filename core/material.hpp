#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "core/rgb.hpp"
#include "core/thermal.hpp"

namespace fluxel {

/// Which sides of a surface send and receive: the side of its normal, or both. Light is emitted by the front
/// alone, heat by every side that sends.
enum class Sides { one, two };

/// What a surface does with light beside reflecting it evenly: shares of what arrives on either side, linear,
/// 0..1.
struct SurfaceOptics {
  Rgb mirror{0};                ///< reflected as by a mirror
  Rgb transmission{0};          ///< straight through, as through a thin sheet
  Rgb diffuse_transmission{0};  ///< through, and evenly in all directions there
  /// Of the clear body that the surface bounds, its normals outwards, over that of air: light is reflected
  /// and refracted after Fresnel. 0: the surface bounds none.
  double refraction_index = 0;

  bool operator==(const SurfaceOptics&) const = default;
  [[nodiscard]] bool bounds_clear_body() const { return refraction_index > 0; }
  [[nodiscard]] bool lets_light_through() const {
    return bounds_clear_body() || transmission != Rgb(0) || diffuse_transmission != Rgb(0);
  }
};

/// A surface that reflects evenly (Lambertian), and may do more.
struct Material {
  std::string name;
  Rgb rho{0.5};  ///< reflectance, linear, 0..1
  Rgb E{0.0};    ///< emitted exitance of the front [W/m2] or [lm/m2]; of heat below 0 where a flux is drawn
  Sides sides = Sides::one;
  /// Of a thermal run: what rho and E come from, with convection at first_irradiance.
  std::optional<ThermalSurface> thermal = std::nullopt;
  SurfaceOptics optics{};  ///< which paths and photons alone know; none of it for heat

  [[nodiscard]] bool emits() const { return E != Rgb(0); }
  /// The exitance of the back: that of the front for heat, none for light.
  [[nodiscard]] Rgb back_exitance() const { return thermal ? E : Rgb(0); }
  /// Whether it reflects evenly and does nothing else.
  [[nodiscard]] bool is_diffuse() const { return optics == SurfaceOptics{}; }
  /// The share of light that is not absorbed.
  [[nodiscard]] Rgb kept() const {
    if (optics.bounds_clear_body()) return Rgb(1);
    return rho + optics.mirror + optics.transmission + optics.diffuse_transmission;
  }
  /// Whether rho and E are but a beginning: those of a side follow from its temperature.
  [[nodiscard]] bool has_convection() const { return thermal && thermal->has_convection(); }
};

/// All that light depends on, to compare: colours one after another, then the index of refraction.
[[nodiscard]] inline std::array<double, 6 * kChannels + 1> light_of(const Material& material) {
  const SurfaceOptics& optics = material.optics;
  std::array<double, 6 * kChannels + 1> values{};
  std::size_t at = 0;
  for (const Rgb& colour : {material.rho, material.E, material.back_exitance(), optics.mirror,
                            optics.transmission, optics.diffuse_transmission})
    for (int c = 0; c < kChannels; ++c) values[at++] = colour[c];
  values[at] = optics.refraction_index;
  return values;
}

/// Shares that add up to 1 may do so within this.
inline constexpr double kSharesRounding = 1e-9;

}  // namespace fluxel

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// What a pixel sees.
struct SeenSurface {
  static constexpr std::uint32_t kNothing = 0xFFFFFFFFu;

  glm::dvec3 position{0};
  glm::dvec3 normal{0};               ///< unit, of the side
  std::uint32_t material = kNothing;  ///< only pixels of one material are alike
};

/// Two independent measurements of the irradiance of each pixel [W/m2], as good as each other.
using IrradianceHalves = std::array<std::vector<Rgb>, 2>;

/// Means over neighbouring pixels of one surface in place of noise. A neighbour counts the more, the less the
/// one half of its surroundings differs from those of the pixel beyond the noise, and it is the other half
/// that is averaged, so that noise does not choose itself (non-local means: Buades, Coll & Morel 2005; its
/// use on two halves of a rendering: Rousselle, Knaus & Zwicker 2012).
class IrradianceFilter {
 public:
  /// Row-major, of whole rows of `width` pixels.
  IrradianceFilter(int width, std::vector<SeenSurface> seen);

  /// Both halves of the pixels from one number to before another. Neighbours of all numbers are looked at.
  [[nodiscard]] IrradianceHalves filter(const IrradianceHalves& halves, std::size_t from, std::size_t to,
                                        int threads) const;

 private:
  class Window;

  [[nodiscard]] std::vector<double> noise_of(const std::array<std::vector<double>, 2>& sizes,
                                             int threads) const;

  int width_, height_;
  std::vector<SeenSurface> seen_;
  std::vector<std::uint64_t> alike_;  // a bit for each pixel of the window around each one
};

}  // namespace fluxel

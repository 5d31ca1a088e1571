#include "scene/readers/doubtful_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <limits>

#include "scene/readers/geometry_formats.hpp"

namespace fluxel {

namespace {

constexpr double kLargest = 1000, kSmallest = 0.05;  // of what is taken for metres
constexpr double kMillimetre = 1e-3, kMicrometre = 1e-6;

/// The longest side of the box around all polygons [m]; 0 of none.
double width_of(const SceneInput& input) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const InputPolygon& polygon : input.polygons)
    for (const glm::dvec3& corner : polygon.corners) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z, 0.0});
}

}  // namespace

std::optional<std::string> doubt_of_unit(const SceneInput& input) {
  const double width = width_of(input);
  if (width == 0 || (width >= kSmallest && width <= kLargest) ||
      std::ranges::all_of(input.geometry, &InputGeometry::unit_given))
    return std::nullopt;
  const auto give = [&](double metres) {
    return fmt::format("{}{:g}",
                       lower_extension(input.file) == ".toml"
                           ? "write into its [[geometry]] metres_per_unit = "
                           : "give --metres-per-unit ",
                       metres);
  };
  if (width < kSmallest)
    return fmt::format("the scene is {:.3g} m wide: if its unit is the kilometre, {} (1 for metres)", width,
                       give(1000));
  if (width * kMillimetre > kLargest)
    return fmt::format("the scene is {:.0f} m wide: if its unit is the micrometre, {} (1 for metres)", width,
                       give(kMicrometre));
  return fmt::format(
      "the scene is {:.0f} m wide: if its unit is the millimetre, {} (0.01 for centimetres, 0.0254 for "
      "inches, 1 for metres)",
      width, give(kMillimetre));
}

}  // namespace fluxel

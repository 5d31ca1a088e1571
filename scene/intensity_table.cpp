#include "scene/intensity_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/odd_moment.hpp"

namespace fluxel {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;

/// A place between two angles: the first's index, and how far on the second is.
struct Between {
  std::size_t first = 0;
  double fraction = 0;
};

/// Where `angle` stands among ascending angles, of which it lies within the first and the last.
Between find_between(const std::vector<double>& angles, double angle) {
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, angle);
  const double low = *(above - 1);
  return {static_cast<std::size_t>(above - angles.begin()) - 1, (angle - low) / (*above - low)};
}

double in_plane(const IntensityTable& table, std::size_t c, const Between& gamma) {
  return std::lerp(table.at(c, gamma.first), table.at(c, gamma.first + 1), gamma.fraction);
}

/// The integral of I(gamma) sin(gamma) along a plane: over the angles within h of the middle m of two angles,
/// of I = I_m + slope (gamma - m), it is 2 sin(m) sin(h) I_m + 2 cos(m) (sin(h) - h cos(h)) slope.
double plane_integral(const IntensityTable& table, std::size_t c) {
  double sum = 0;
  for (std::size_t g = 0; g + 1 < table.gamma.size(); ++g) {
    const double low = table.at(c, g), high = table.at(c, g + 1);
    const double h = (table.gamma[g + 1] - table.gamma[g]) / 2, m = table.gamma[g] + h;
    sum += std::sin(m) * std::sin(h) * (low + high) + std::cos(m) * odd_moment(h) * (high - low);
  }
  return sum;
}

}  // namespace

double intensity(const IntensityTable& table, double C, double gamma) {
  if (!(gamma >= table.gamma.front() && gamma <= table.gamma.back())) return 0;
  const Between at_gamma = find_between(table.gamma, gamma);
  if (table.C.size() == 1) return in_plane(table, 0, at_gamma);
  const double within = std::clamp(C - kWholeTurn * std::floor(C / kWholeTurn), 0.0, kWholeTurn);
  const Between at_C = find_between(table.C, within);
  return std::lerp(in_plane(table, at_C.first, at_gamma), in_plane(table, at_C.first + 1, at_gamma),
                   at_C.fraction);
}

double flux(const IntensityTable& table) {
  if (table.C.size() == 1) return kWholeTurn * plane_integral(table, 0);
  double sum = 0, before = plane_integral(table, 0);
  for (std::size_t c = 1; c < table.C.size(); ++c) {
    const double here = plane_integral(table, c);
    sum += (table.C[c] - table.C[c - 1]) * (before + here) / 2;
    before = here;
  }
  return sum;
}

double largest_intensity(const IntensityTable& table) { return std::ranges::max(table.intensity); }

}  // namespace fluxel

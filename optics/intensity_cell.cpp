#include "optics/intensity_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "optics/newton.hpp"
#include "scene/odd_moment.hpp"

namespace fluxel {

namespace {

/// Of a cell's flux, and of its extent: nearer than that an angle is found.
constexpr double kClose = 1e-14;

}  // namespace

IntensityCell::IntensityCell(const IntensityTable& table, std::size_t c, std::size_t g)
    : gamma_{table.gamma[g], table.gamma[g + 1]} {
  const bool is_turned = table.C.size() > 1;
  C_ = is_turned ? std::array{table.C[c], table.C[c + 1]} : std::array{0.0, 2 * std::numbers::pi};
  const std::size_t other = is_turned ? c + 1 : c;
  intensity_ = {{{table.at(c, g), table.at(other, g)}, {table.at(c, g + 1), table.at(other, g + 1)}}};
  first_ = 0.5 * (intensity_[0][0] + intensity_[0][1]);
  slope_ = (0.5 * (intensity_[1][0] + intensity_[1][1]) - first_) / (gamma_[1] - gamma_[0]);
  flux_ = flux_below(gamma_[1]);
}

/// The integral of the mean intensity times sin(gamma), from the first angle on, times the extent in C. With
/// h half of the way and m its middle: 2 sin(m) sin(h) (I + slope h) + 2 cos(m) (sin(h) - h cos(h)) slope.
double IntensityCell::flux_below(double gamma) const {
  const double h = 0.5 * (gamma - gamma_[0]), m = gamma_[0] + h;
  return (C_[1] - C_[0]) * 2 *
         (std::sin(m) * std::sin(h) * (first_ + slope_ * h) + std::cos(m) * h * odd_moment(h) * slope_);
}

IntensityAngles IntensityCell::direction(double of_gamma, double of_C) const {
  const double wanted = of_gamma * flux_;
  const double gamma = root_by_newton(
      [&](double angle) { return flux_below(angle) - wanted; },
      [&](double angle) {
        return (C_[1] - C_[0]) * (first_ + slope_ * (angle - gamma_[0])) * std::sin(angle);
      },
      gamma_[0], gamma_[1], std::lerp(gamma_[0], gamma_[1], of_gamma), kClose * gamma_[1], kClose * flux_);
  // Linear in C: the stable root of the quadratic of its running integral.
  const double t = (gamma - gamma_[0]) / (gamma_[1] - gamma_[0]);
  const double from = std::lerp(intensity_[0][0], intensity_[1][0], t),
               to = std::lerp(intensity_[0][1], intensity_[1][1], t);
  const double root = std::sqrt(std::max(0.0, from * from + of_C * (to - from) * (to + from)));
  const double s = from + root > 0 ? of_C * (from + to) / (from + root) : of_C;
  return {std::lerp(C_[0], C_[1], std::min(s, 1.0)), gamma};
}

}  // namespace fluxel

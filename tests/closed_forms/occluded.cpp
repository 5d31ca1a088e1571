#include "tests/closed_forms/occluded.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/closed_forms/points.hpp"

namespace fluxel::closed_forms {

namespace {

using std::numbers::pi;
using Gauss = boost::math::quadrature::gauss<double, 30>;

/// An infinitesimally wide strip [0, height] at distance x from a wall at right angles, to the wall's first
/// `visible`:
///   x/pi int_x^d atan(height/r)/r^2 dr,  d^2 = x^2 + visible^2.
double strip_to_wall(double x, double visible, double height) {
  const auto primitive = [height](double u) {
    return u * std::atan(height * u) - std::log1p(height * u * (height * u)) / (2 * height);
  };
  return x / pi * (primitive(1 / x) - primitive(1 / std::hypot(x, visible)));
}

/// Where the edges of a shadow [2 low - p, 2 high - p] cross 0 or 1, for p from 0 to 1.
std::vector<double> breaks(double low, double high) {
  std::vector<double> found{0, 1};
  for (const double p : {2 * low - 1, 2 * low, 2 * high - 1, 2 * high}) {
    if (p > 0 && p < 1) found.push_back(p);
  }
  std::ranges::sort(found);
  return found;
}

template <class Function>
double integrate_pieces(const std::vector<double>& ends, Function function) {
  double sum = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (ends[i] > ends[i - 1]) sum += Gauss::integrate(function, ends[i - 1], ends[i]);
  }
  return sum;
}

double shadowed(const Rectangle& blocker) {
  const auto at_point = [&blocker](double px, double py) {
    const auto edge = [](double b, double p) { return std::clamp(2 * b - p, 0.0, 1.0) - p; };
    const Rectangle shadow{.u_low = edge(blocker.u_low, px),
                           .u_high = edge(blocker.u_high, px),
                           .v_low = edge(blocker.v_low, py),
                           .v_high = edge(blocker.v_high, py)};
    return point_to_parallel_rectangle(shadow, 1);
  };
  const std::vector<double> y_breaks = breaks(blocker.v_low, blocker.v_high);
  const auto along_y = [&](double px) {
    return integrate_pieces(y_breaks, [&](double py) { return at_point(px, py); });
  };
  return integrate_pieces(breaks(blocker.u_low, blocker.u_high), along_y);
}

}  // namespace

double crossed_strings(const Strings& strings, double sender_length) {
  return (strings.crossed - strings.uncrossed) / (2 * sender_length);
}

double l_corridor(double arm, double width) {
  // The walls share an edge: one uncrossed string has no length, the other bends at the corner if that is in
  // its way.
  const double free = std::hypot(arm, arm), bent = 2 * std::hypot(arm - width, width);
  return crossed_strings({.crossed = 2 * arm, .uncrossed = 2 * width < arm ? bent : free}, arm);
}

double l_room(double arm, double width, double height) {
  if (2 * width >= arm) return adjacent_rectangles(arm, arm, height);
  const double free = width * arm / (arm - width);  // up to here all of the other wall is visible
  const auto past_corner = [&](double c) { return strip_to_wall(c, width * c / (c - width), height); };
  const double whole = free * adjacent_rectangles(free, arm, height);
  return (whole + Gauss::integrate(past_corner, free, arm)) / arm;
}

double opposed_squares_past(std::span<const Rectangle> blockers) {
  double visible = opposed_rectangles(1, 1, 1);
  for (const Rectangle& blocker : blockers) visible -= shadowed(blocker);
  return visible;
}

Rectangle centred_blocker(double side) {
  const double low = (1 - side) / 2, high = (1 + side) / 2;
  return {.u_low = low, .u_high = high, .v_low = low, .v_high = high};
}

}  // namespace fluxel::closed_forms

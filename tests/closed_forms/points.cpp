#include "tests/closed_forms/points.hpp"

#include <cmath>
#include <numbers>

namespace fluxel::closed_forms {

namespace {

using std::numbers::pi;

/// B-3 for a corner at (a, b), odd in both.
double parallel_corner(double a, double b) {
  const double s = std::hypot(1, a), t = std::hypot(1, b);
  return (a / s * std::atan(b / s) + b / t * std::atan(a / t)) / (2 * pi);
}

/// B-4 for a rectangle that starts at the foot, odd in its width.
double perpendicular_corner(double distance, double height, double width) {
  const double slant = std::hypot(height, distance);
  return (std::atan(width / distance) - distance / slant * std::atan(width / slant)) / (2 * pi);
}

}  // namespace

double point_to_parallel_rectangle(const Rectangle& receiver, double gap) {
  const double x1 = receiver.u_low / gap, x2 = receiver.u_high / gap;
  const double y1 = receiver.v_low / gap, y2 = receiver.v_high / gap;
  return parallel_corner(x2, y2) - parallel_corner(x1, y2) - parallel_corner(x2, y1) +
         parallel_corner(x1, y1);
}

double point_to_perpendicular_rectangle(double distance, const Rectangle& receiver) {
  const auto upto = [&](double height) {
    return perpendicular_corner(distance, height, receiver.v_high) -
           perpendicular_corner(distance, height, receiver.v_low);
  };
  return upto(receiver.u_high) - upto(receiver.u_low);
}

double point_to_coaxial_disc(double radius, double gap) {
  return radius * radius / (gap * gap + radius * radius);
}

}  // namespace fluxel::closed_forms

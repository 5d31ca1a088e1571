#include "tests/closed_forms/rectangles.hpp"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace fluxel::closed_forms {

namespace {

using std::numbers::pi;

/// Of C-13, with p and q the offsets of two corners.
double parallel_term(double p, double q, double gap) {
  const double a = std::hypot(p, gap), b = std::hypot(q, gap);
  return (q * a * std::atan(q / a) + p * b * std::atan(p / b) -
          gap * gap / 2 * std::log(p * p + q * q + gap * gap)) /
         (2 * pi);
}

/// Of C-15, with x and z the distances of two corners from the common line and q their offset along it.
double perpendicular_term(double x, double q, double z) {
  const double c = std::hypot(x, z);
  if (c == 0) return q == 0 ? 0 : q * q * std::log(q * q) / (8 * pi);
  return (q * c * std::atan(q / c) - (c * c - q * q) * std::log(c * c + q * q) / 4) / (2 * pi);
}

double sign(unsigned i, unsigned j, unsigned k, unsigned l) { return (i + j + k + l) % 2 == 0 ? 1 : -1; }

/// The sum over the corners of both rectangles, signed, of term(u of the sender, u of the receiver,
/// difference in v).
template <class Term>
double sum_over_corners(const Rectangle& sender, const Rectangle& receiver, Term term) {
  const std::array u{sender.u_low, sender.u_high}, v{sender.v_low, sender.v_high};
  const std::array s{receiver.u_low, receiver.u_high}, t{receiver.v_low, receiver.v_high};
  double sum = 0;
  for (const unsigned i : {0U, 1U}) {
    for (const unsigned j : {0U, 1U}) {
      for (const unsigned k : {0U, 1U}) {
        for (const unsigned l : {0U, 1U}) sum += sign(i, j, k, l) * term(u[i], s[l], v[j] - t[k]);
      }
    }
  }
  return sum;
}

}  // namespace

double area(const Rectangle& rectangle) {
  return (rectangle.u_high - rectangle.u_low) * (rectangle.v_high - rectangle.v_low);
}

double opposed_rectangles(double a, double b, double gap) {
  const double X = std::max(a, b) / gap, Y = std::min(a, b) / gap;
  constexpr double kFewDigitsLost = 0.5;
  if (Y < kFewDigitsLost) {
    const auto strip = [X, Y](double y) {
      const double s = std::hypot(1, y);
      return (Y - y) * std::atan(X / s) / (s * s * s);
    };
    return 2 / (pi * Y) * boost::math::quadrature::gauss<double, 20>::integrate(strip, 0.0, Y);
  }
  const double x = std::hypot(1, X), y = std::hypot(1, Y);
  const double logarithm = std::log1p(X * X * Y * Y / (1 + X * X + Y * Y)) / 2;
  return 2 / (pi * X * Y) *
         (logarithm + X * y * std::atan(X / y) + Y * x * std::atan(Y / x) - X * std::atan(X) -
          Y * std::atan(Y));
}

double adjacent_rectangles(double width, double height, double edge) {
  const double W = width / edge, H = height / edge, W2 = W * W, H2 = H * H, diagonal = std::hypot(W, H);
  // The three logarithms of the textbook, each of 1 + something small where the rectangles are long.
  const double logarithms = std::log1p(W2 * H2 / (1 + W2 + H2)) +
                            W2 * std::log1p(-H2 / ((1 + W2) * (W2 + H2))) +
                            H2 * std::log1p(-W2 / ((1 + H2) * (W2 + H2)));
  return (W * std::atan(1 / W) + H * std::atan(1 / H) - diagonal * std::atan(1 / diagonal) + logarithms / 4) /
         (pi * W);
}

double parallel_rectangles(const Rectangle& sender, const Rectangle& receiver, double gap) {
  const auto term = [gap](double x, double u, double q) { return parallel_term(x - u, q, gap); };
  return sum_over_corners(sender, receiver, term) / area(sender);
}

double perpendicular_rectangles(const Rectangle& sender, const Rectangle& receiver) {
  const auto term = [](double x, double z, double q) { return perpendicular_term(x, q, z); };
  return sum_over_corners(sender, receiver, term) / area(sender);
}

}  // namespace fluxel::closed_forms

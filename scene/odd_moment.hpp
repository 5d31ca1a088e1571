#pragma once

#include <cmath>

namespace fluxel {

/// (sin(h) - h cos(h)) / h without the cancellation of small h.
[[nodiscard]] inline double odd_moment(double h) {
  if (h > 0.1) return std::sin(h) / h - std::cos(h);
  const double h2 = h * h;
  return h2 / 3 * (1 - h2 / 10 * (1 - h2 / 28 * (1 - h2 / 54)));
}

}  // namespace fluxel

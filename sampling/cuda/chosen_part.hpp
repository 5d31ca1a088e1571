#pragma once

// Portable: what a device compiles too.

#include <cmath>
#include <cstddef>

#include "core/portable.hpp"

namespace fluxel::cuda {

/// Which of parts in a row a number in [0, 1) falls on, each by its length, and where in it, in [0, 1].
struct ChosenPart {
  std::size_t number;
  double rest;  ///< uniform again (Dmitriev 2002, equation 12)
};

/// `ends`: running sums of the lengths of `count` parts, at least one.
FLUXEL_PORTABLE inline ChosenPart chosen_part(const double* ends, std::size_t count, double u) {
  const double at = u * ends[count - 1];
  std::size_t first = 0, last = count - 1;
  while (first < last) {
    const std::size_t middle = (first + last) / 2;
    if (ends[middle] > at) {
      last = middle;
    } else {
      first = middle + 1;
    }
  }
  const double start = first > 0 ? ends[first - 1] : 0;
  return {first, std::fmin(std::fmax((at - start) / (ends[first] - start), 0.0), 1.0)};
}

}  // namespace fluxel::cuda

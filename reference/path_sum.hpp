#pragma once

#include "core/rgb.hpp"

namespace fluxel {

/// What paths have found, and how evenly it comes from them.
struct PathSum {
  Rgb sum{0};
  double squares = 0;  ///< of what each has found, mean of the colours

  void add(const Rgb& found) {
    const double mean = mean_of_colours(found);
    sum += found;
    squares += mean * mean;
  }
  void add(const PathSum& other) {
    sum += other.sum;
    squares += other.squares;
  }

  /// The effective number of paths that have brought something (Kish 1965): of equal ones their number, and
  /// fewer where few bring most of it. 0: none has.
  [[nodiscard]] double contributions() const {
    return squares > 0 ? mean_of_colours(sum) * mean_of_colours(sum) / squares : 0;
  }
  /// What one of them has brought; 0 where there is none.
  [[nodiscard]] Rgb contribution() const {
    const double mean = mean_of_colours(sum);
    return mean != 0 ? sum * (squares / (mean * mean)) : Rgb(0);
  }
};

}  // namespace fluxel

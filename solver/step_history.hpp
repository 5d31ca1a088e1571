#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace fluxel {

/// Recognises growth and standstill from the largest changes of iterations [W/m2]; the relative one is
/// infinite where the mean is not above 0, as it may be for a while where heat is drawn.
class StepHistory {
 public:
  /// `contraction`: of the change an iteration leaves at most so much; 0: not known.
  explicit StepHistory(double contraction) {
    // A shot of half the light gains half as much, and the largest change of all jumps up and down.
    if (contraction < 1) patience_ = std::max(patience_, std::log(0.1) / std::log((1 + contraction) / 2));
  }

  void add(double change, double relative_change) {
    last_ = change;
    relative_ = relative_change;
    smallest_ = std::min(smallest_, last_);
    // Compared with the last mark, not with the last step, slow progress adds up to some.
    if (last_ < kNoticed * mark_) {
      mark_ = last_;
      since_mark_ = 0;
    } else {
      ++since_mark_;
    }
  }
  [[nodiscard]] bool grows() const { return !std::isfinite(last_) || last_ > 10 * smallest_; }
  /// Far enough that no rounding explains it.
  [[nodiscard]] bool diverged() const { return !std::isfinite(last_) || last_ > 1e6 * smallest_; }
  /// Over so many iterations that even a reflectance of 0.9999 would show, or whatever the contraction is.
  [[nodiscard]] bool stands_still() const { return since_mark_ >= patience_ && relative_ < 1e-5; }

 private:
  static constexpr double kNoticed = 0.99;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  double smallest_ = kInfinity;
  double last_ = 0;
  double relative_ = 0;
  double mark_ = kInfinity;
  double patience_ = 200;
  int since_mark_ = 0;
};

/// Checks of the true error of a method whose recurrence says that it is good enough. One that drifts
/// off again and again without much gain is at the operator's rounding.
class TrueErrorChecks {
 public:
  /// With the bound of the next check; true: no more can be had.
  [[nodiscard]] bool stall(double bound) {
    const bool gained = bound <= kMinGain * best_;
    if (gained) best_ = bound;
    idle_ = gained ? 0 : idle_ + 1;
    return idle_ >= kPatience;
  }

 private:
  static constexpr double kMinGain = 0.9;
  static constexpr int kPatience = 20;

  double best_ = std::numeric_limits<double>::infinity();
  int idle_ = 0;
};

}  // namespace fluxel

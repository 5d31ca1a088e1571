#pragma once

#include <string>
#include <utility>
#include <vector>

#include "metrics/forecast.hpp"

namespace fluxel {

/// What a long phase has shown, moment after moment, with the forecast of its end at each. Samples are
/// thinned, every other one at a time, so that there are fewer than kMaxSamples however long the phase
/// takes.
class PhaseRecord {
 public:
  static constexpr std::size_t kMaxSamples = 200;

  /// `restored`: work that an earlier job has done.
  explicit PhaseRecord(std::string name, double restored = 0) : name_(std::move(name)), restored_(restored) {}

  /// At `seconds` since the phase's start, which ascend, `done` of `total` work is done. True where that
  /// became a sample, with a new forecast; what comes too soon after the last one becomes none.
  bool add(double seconds, double done, double total);
  /// The same of a phase that ends when its error has come to `target`.
  bool add_error(double seconds, const ErrorProgress& state);
  /// The phase has ended: what was reported last becomes the last sample, at this moment.
  void finish(double seconds);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<PhaseSample>& samples() const { return samples_; }
  /// As the last sample has it [s since the phase's start].
  [[nodiscard]] double forecast() const {
    return samples_.empty() ? PhaseSample::kUnknown : samples_.back().forecast;
  }
  [[nodiscard]] bool finished() const { return finished_; }
  /// Whether an error drives the phase.
  [[nodiscard]] bool has_errors() const { return !samples_.empty() && samples_.back().target > 0; }

 private:
  /// Whether it became one.
  bool sample(const PhaseSample& latest);

  std::string name_;
  double restored_;
  std::vector<PhaseSample> samples_;
  PhaseSample latest_;
  double spacing_ = 0.01;  // between samples, at least [s]
  bool finished_ = false;
};

}  // namespace fluxel

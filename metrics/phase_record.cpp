#include "metrics/phase_record.hpp"

namespace fluxel {

bool PhaseRecord::add(double seconds, double done, double total) {
  if (!sample({seconds, done})) return false;
  samples_.back().forecast = forecast_by_work(samples_, total, restored_);
  return true;
}

bool PhaseRecord::add_error(double seconds, const ErrorProgress& state) {
  if (!sample({seconds, state.done, state.error, state.target})) return false;
  samples_.back().forecast = forecast_by_error(samples_, state.law, state.target, state.closing, restored_);
  return true;
}

void PhaseRecord::finish(double seconds) {
  finished_ = true;
  if (samples_.empty()) return;
  latest_.seconds = latest_.forecast = seconds;
  samples_.push_back(latest_);
}

bool PhaseRecord::sample(const PhaseSample& latest) {
  latest_ = latest;
  if (!samples_.empty() && latest.seconds < samples_.back().seconds + spacing_) return false;
  if (samples_.size() + 2 > kMaxSamples) {
    std::vector<PhaseSample> every_other;
    for (std::size_t k = 0; k < samples_.size(); k += 2) every_other.push_back(samples_[k]);
    samples_ = std::move(every_other);
    spacing_ *= 2;
  }
  samples_.push_back(latest);
  return true;
}

}  // namespace fluxel

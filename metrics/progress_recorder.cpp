#include "metrics/progress_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

namespace fluxel {

ProgressRecorder::ProgressRecorder(ProgressDisplay& display, Keep keep, std::chrono::milliseconds keep_every)
    : display_(display), keep_(std::move(keep)), keep_every_(keep_every) {}

void ProgressRecorder::begin(const std::string& phase, double restored) {
  display_.begin(phase);
  records_.emplace_back(phase, restored);
  start_ = Clock::now();
}

void ProgressRecorder::update(double done, double total, const std::string& detail) {
  PhaseRecord& record = records_.back();
  const double now = seconds();
  if (record.add(now, done, total)) keep_in_time();
  display_.show(total > 0 ? done / total : 0, std::max(0.0, record.forecast() - now), with_error(detail));
}

void ProgressRecorder::update_error(const ErrorProgress& state, const std::string& detail) {
  PhaseRecord& record = records_.back();
  const double now = seconds();
  if (record.add_error(now, state)) keep_in_time();
  std::string shown = with_error(detail);
  // Of iterations it is the residual, which says nothing of the light.
  if (std::isfinite(state.error) && state.law != ErrorLaw::geometric) {
    if (!shown.empty()) shown += ", ";
    shown += fmt::format("error {:.2g} % where {:.2g} % is asked for", 100 * state.error, 100 * state.target);
  }
  display_.show(now / record.forecast(), std::max(0.0, record.forecast() - now), shown);
}

void ProgressRecorder::end() {
  records_.back().finish(seconds());
  display_.end();
}

const std::vector<PhaseRecord>& ProgressRecorder::records() {
  if (keeping_.valid()) keeping_.get();
  return records_;
}

std::string ProgressRecorder::with_error(const std::string& detail) const {
  if (!reached_) return detail;
  return fmt::format("{}{}error until now {:.2g} %", detail, detail.empty() ? "" : ", ", 100 * *reached_);
}

double ProgressRecorder::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void ProgressRecorder::keep_in_time() {
  if (!keep_ || Clock::now() - kept_ < keep_every_) return;
  if (keeping_.valid()) {
    if (keeping_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    keeping_.get();
  }
  kept_ = Clock::now();
  try {
    keeping_ = std::async(std::launch::async, keep_, records_);
  } catch (const std::system_error&) {  // no thread to be had: later, perhaps
  }
}

}  // namespace fluxel

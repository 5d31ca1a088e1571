#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "metrics/phase_record.hpp"

namespace fluxel {

/// Keeps a record of every phase that is reported to it, and has the record's forecast shown: what a user
/// reads is what the record says.
class ProgressRecorder final : public Progress {
 public:
  /// Is given all records, the running phase's among them.
  using Keep = std::function<void(const std::vector<PhaseRecord>&)>;

  /// `keep` is called now and then while phases run, in a thread of its own, one call at a time; what it is
  /// for is its own. However slow it is, nobody who reports progress waits for it.
  explicit ProgressRecorder(ProgressDisplay& display, Keep keep = {},
                            std::chrono::milliseconds keep_every = std::chrono::seconds(5));

  void begin(const std::string& phase, double restored = 0) override;
  void update(double done, double total, const std::string& detail = {}) override;
  void update_error(const ErrorProgress& state, const std::string& detail = {}) override;
  void reached(double error) override { reached_ = error; }
  void end() override;

  /// Of the phases that have begun, in their order; those that reported nothing have no samples. `keep` has
  /// returned by then, so that it cannot replace what the caller writes of them.
  [[nodiscard]] const std::vector<PhaseRecord>& records();

 private:
  using Clock = std::chrono::steady_clock;

  /// Of the running phase [s].
  [[nodiscard]] double seconds() const;
  void keep_in_time();
  /// What is shown beside how far the phase is.
  [[nodiscard]] std::string with_error(const std::string& detail) const;

  ProgressDisplay& display_;
  std::optional<double> reached_;
  Keep keep_;
  std::vector<PhaseRecord> records_;
  Clock::time_point start_ = Clock::now(), kept_ = start_;
  std::chrono::milliseconds keep_every_;
  std::future<void> keeping_;  // waited for at the latest when this ends
};

}  // namespace fluxel

#pragma once

#include <chrono>
#include <string>

namespace fluxel {

/// Told how far a long phase is. Every rank reports to its own; only rank 0's shows something.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void begin(const std::string& phase) = 0;
  /// `done` of `total` units of work; cheap enough to be called often. `detail` is shown as it is.
  virtual void update(double done, double total, const std::string& detail = {}) = 0;
  virtual void end() = 0;
};

class SilentProgress final : public Progress {
 public:
  void begin(const std::string&) override {}
  void update(double, double, const std::string&) override {}
  void end() override {}
};

/// On a terminal one live line for the running phase, in a pipe a line every five seconds; writes to stderr.
class ConsoleProgress final : public Progress {
 public:
  ConsoleProgress();
  void begin(const std::string& phase) override;
  void update(double done, double total, const std::string& detail) override;
  void end() override;

 private:
  using Clock = std::chrono::steady_clock;
  std::string phase_;
  Clock::time_point start_{}, shown_{};
  bool terminal_;
};

}  // namespace fluxel

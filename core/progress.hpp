#pragma once

#include <chrono>
#include <string>

namespace fluxel {

/// How the error of a phase falls while work is done.
enum class ErrorLaw {
  sampling,  ///< the square is a / done + b / done^2: Monte Carlo, and what even points make quicker of it
  power,     ///< c / done^p, 1/2 <= p <= 1: points of quasi-Monte-Carlo over discontinuous integrands
  geometric  ///< c q^done: iterations of a linear solver
};

/// Where a phase stands that ends when its error has come to a target.
struct ErrorProgress {
  double done;   ///< work, in a unit of the phase's own (iterations, rays); what was restored counts
  double error;  ///< infinite where it is not known yet
  double target;
  ErrorLaw law;
  double closing = 0;  ///< work that follows when the target is reached
};

/// How far a long phase is; every rank reports its own part.
class Progress {
 public:
  virtual ~Progress() = default;
  /// `restored`: work of the phase that an earlier job has done.
  virtual void begin(const std::string& phase, double restored = 0) = 0;
  /// `done` of `total` units of work; cheap enough to be called often. `detail` is shown as it is.
  virtual void update(double done, double total, const std::string& detail = {}) = 0;
  /// The same, where an error decides.
  virtual void update_error(const ErrorProgress& state, const std::string& detail = {}) = 0;
  /// The error of what a run of several phases has come to until now, over its mean, for those who watch.
  virtual void reached(double /*error*/) {}
  virtual void end() = 0;
};

class SilentProgress final : public Progress {
 public:
  void begin(const std::string&, double) override {}
  void update(double, double, const std::string&) override {}
  void update_error(const ErrorProgress&, const std::string&) override {}
  void end() override {}
};

/// Shows how far a long phase is.
class ProgressDisplay {
 public:
  virtual ~ProgressDisplay() = default;
  virtual void begin(const std::string& phase) = 0;
  /// `fraction` of the phase is done, and it has `seconds_left` (infinite: not known).
  virtual void show(double fraction, double seconds_left, const std::string& detail) = 0;
  virtual void end() = 0;
};

class NoDisplay final : public ProgressDisplay {
 public:
  void begin(const std::string&) override {}
  void show(double, double, const std::string&) override {}
  void end() override {}
};

/// On a terminal one live line for the running phase, in a pipe a line every five seconds; writes to stderr.
class ConsoleDisplay final : public ProgressDisplay {
 public:
  ConsoleDisplay();
  void begin(const std::string& phase) override;
  void show(double fraction, double seconds_left, const std::string& detail) override;
  void end() override;

 private:
  using Clock = std::chrono::steady_clock;
  std::string phase_;
  Clock::time_point start_{}, shown_{};
  bool terminal_;
};

}  // namespace fluxel

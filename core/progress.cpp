#include "core/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace fluxel {

ConsoleDisplay::ConsoleDisplay() : terminal_(isatty(STDERR_FILENO) != 0) {}

void ConsoleDisplay::begin(const std::string& phase) {
  phase_ = phase;
  start_ = shown_ = Clock::now();
}

void ConsoleDisplay::show(double fraction, double seconds_left, const std::string& detail) {
  const auto now = Clock::now();
  if (now - shown_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(5000))) return;
  shown_ = now;
  std::string line = fmt::format("{}: {:.0f} %", phase_, 100 * fraction);
  if (std::isfinite(seconds_left)) line += fmt::format(", {:.0f} s left", seconds_left);
  if (!detail.empty()) line += ", " + detail;
  fmt::print(stderr, "{}", terminal_ ? "\r\x1b[K" + line : line + "\n");
  std::fflush(stderr);
}

void ConsoleDisplay::end() {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  // A terminal shows what is under way; what was done is said by the run itself.
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[K");
  } else {
    fmt::print(stderr, "{}: done in {:.2f} s\n", phase_, seconds);
  }
  std::fflush(stderr);
}

}  // namespace fluxel

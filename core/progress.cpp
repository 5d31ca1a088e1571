#include "core/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace fluxel {

ConsoleProgress::ConsoleProgress() : terminal_(isatty(STDERR_FILENO) != 0) {}

void ConsoleProgress::begin(const std::string& phase) {
  phase_ = phase;
  start_ = shown_ = Clock::now();
}

void ConsoleProgress::update(double done, double total, const std::string& detail) {
  const auto now = Clock::now();
  if (now - shown_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(5000))) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double fraction = total > 0 ? done / total : 0;
  std::string line = fmt::format("{}: {:.0f} %", phase_, 100 * fraction);
  if (fraction > 0) line += fmt::format(", {:.0f} s left", seconds * (1 - fraction) / fraction);
  if (!detail.empty()) line += ", " + detail;
  fmt::print(stderr, "{}", terminal_ ? "\r\x1b[K" + line : line + "\n");
  std::fflush(stderr);
}

void ConsoleProgress::end() {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  fmt::print(stderr, "{}{}: done in {:.2f} s\n", terminal_ ? "\r\x1b[K" : "", phase_, seconds);
}

}  // namespace fluxel

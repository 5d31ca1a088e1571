#include "app/run_log.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace fluxel {

void RunLog::say(const std::string& sentence) {
  if (!root_ || quiet_) return;
  fmt::print("{}\n", sentence);
  std::fflush(stdout);
}

void RunLog::warn(const std::string& sentence) {
  warnings_.push_back(sentence);
  if (root_) fmt::print(stderr, "warning: {}\n", sentence);
}

}  // namespace fluxel

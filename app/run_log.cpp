#include "app/run_log.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "app/terminal.hpp"

namespace fluxel {

void RunLog::say(const std::string& sentence) {
  if (!root_ || quiet_) return;
  fmt::print("{}\n", sentence);
  std::fflush(stdout);
}

void RunLog::warn(const std::string& sentence) {
  warnings_.push_back(sentence);
  if (root_) print_message(MessageKind::warning, "warning", sentence);
}

}  // namespace fluxel

#pragma once

#include <string>

namespace fluxel {

/// Where a run's sentences go. All ranks say them; who shows and keeps them is the implementation's.
class Log {
 public:
  virtual ~Log() = default;
  /// What the run does or has found.
  virtual void say(const std::string& sentence) = 0;
  /// What the user should know before trusting the result; stands in the report too.
  virtual void warn(const std::string& sentence) = 0;
};

class SilentLog final : public Log {
 public:
  void say(const std::string&) override {}
  void warn(const std::string&) override {}
};

}  // namespace fluxel

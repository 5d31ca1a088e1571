#pragma once

#include <string>
#include <vector>

#include "core/log.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// What a run tells the user: sentences on standard output, warnings on standard error, by the root alone.
class RunLog final : public Log {
 public:
  RunLog(const Communicator& world, bool quiet) : root_(world.is_root()), quiet_(quiet) {}

  void say(const std::string& sentence) override;
  void warn(const std::string& sentence) override;

  /// All warnings so far.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  bool root_, quiet_;
  std::vector<std::string> warnings_;
};

}  // namespace fluxel

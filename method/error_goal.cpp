#include "method/error_goal.hpp"

#include <span>

#include "core/options.hpp"
#include "mpi_master/communication/machine.hpp"

namespace fluxel {

namespace {

/// Tree and links may take this part of the memory that there is.
constexpr double kMemoryShare = 0.8;

}  // namespace

ErrorGoal goal_of(const Problem& problem, double points) {
  const Options& options = problem.options;
  std::uint64_t available = available_bytes(problem.world.host().size());
  problem.world.all_min(std::span(&available, 1));
  return {options.block_error ? 0 : options.target_error.value_or(kTargetError),
          options.block_error.value_or(0),
          options.memory.value_or(static_cast<std::uint64_t>(kMemoryShare * static_cast<double>(available))),
          points};
}

}  // namespace fluxel

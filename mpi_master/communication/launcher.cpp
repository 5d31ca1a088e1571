#include "mpi_master/communication/launcher.hpp"

#include <cstdlib>

namespace fluxel {

std::optional<int> rank_by_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID", "FLUX_TASK_RANK",
                           "PALS_RANKID", "ALPS_APP_PE"})
    if (const char* rank = std::getenv(name)) return std::atoi(rank);
  return std::nullopt;
}

void start_alone() {
  if (rank_by_launcher()) return;
  // No daemon, which only jobs that start further ranks need (0.1 s).
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  // The point-to-point layer of every build, without a look at all networks first (0.2 s).
  setenv("OMPI_MCA_pml", "ob1", 0);
}

}  // namespace fluxel

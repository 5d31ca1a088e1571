#pragma once

#include <optional>

namespace fluxel {

/// Rank of this process among those that its launcher started, as the launcher's environment says; none
/// where no launcher did.
[[nodiscard]] std::optional<int> rank_by_launcher();

/// Before MPI_Init: a process that no launcher started is a job of one rank, and spares what Open MPI does
/// there for others that might come. What the user has set in the environment stays.
void start_alone();

}  // namespace fluxel

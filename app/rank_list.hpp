#pragma once

#include <string>
#include <vector>

#include "mpi_master/communication/machine.hpp"

namespace fluxel {

/// Names in their order, numbers in a row in brackets, as Slurm writes them: "node[001-064],login".
[[nodiscard]] std::string fold_names(const std::vector<std::string>& names);

/// Which ranks run on which hosts with which CPUs and threads; hosts whose ranks are placed alike share a
/// line: "ranks 0-127 on node[001-064]: on each CPUs 0-15, 16 threads; CPUs 16-31, 16 threads".
[[nodiscard]] std::vector<std::string> rank_list(const std::vector<RankPlace>& places);

}  // namespace fluxel

#pragma once

#include <string>
#include <vector>

#include "bench/simulate/machine_file.hpp"
#include "bench/simulate/traced_scene.hpp"

namespace fluxel::bench {

/// Visibility and solve of the scenes on each number of ranks and each network, as CSV. `vector_bytes`: what
/// a rank holds for each element beside its tiles.
void run_scaling(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                 const std::vector<int>& ranks, double vector_bytes, const std::string& csv);

/// Each scene on as many ranks as give each rank about so many pairs of elements.
void run_weak_scaling(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                      double pairs_a_rank, double vector_bytes, const std::string& csv);

/// The visibility phase with ranks of different speed.
void run_slow_ranks(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                    const std::vector<int>& ranks, const std::string& csv);

/// The visibility phase in strips and in blocks of a pair of patches, on InfiniBand, with waits that never
/// sleep.
void run_tasks(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
               const std::vector<int>& ranks, const std::string& csv);

/// What the visibility phase on this machine should take, where ranks share its cores.
void run_prediction(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                    const std::vector<int>& ranks, int cores, const std::string& csv);

}  // namespace fluxel::bench

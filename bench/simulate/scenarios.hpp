#pragma once

#include <string>
#include <vector>

#include "bench/simulate/machine_file.hpp"
#include "bench/simulate/traced_scene.hpp"

namespace fluxel::bench {

/// Visibility and solve of the scenes on each number of ranks and each network, as CSV. `vector_bytes`: what
/// a rank holds for each element beside its tiles.
void run_scaling(const std::vector<TracedScene>& scenes, const MachineFacts& facts,
                 const std::vector<int>& ranks, double vector_bytes, const std::string& csv);

/// Strips against blocks of a pair of patches, as CSV.
void run_tasks(const std::vector<TracedScene>& scenes, const MachineFacts& facts,
               const std::vector<int>& ranks, const std::string& csv);

/// What a run on this machine should take, as CSV.
void run_prediction(const std::vector<TracedScene>& scenes, const MachineFacts& facts,
                    const std::vector<int>& ranks, int cores, const std::string& csv);

}  // namespace fluxel::bench

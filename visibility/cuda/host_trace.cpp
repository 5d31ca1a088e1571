#include "visibility/cuda/host_trace.hpp"

#include "visibility/cuda/trace_group.hpp"

namespace fluxel::cuda {

TileResult trace_on_host(const TileScene& scene, const TilePlace& place) {
  TileResult result{};
  GroupMemory memory;
  for (std::uint32_t group = 0; group < kGroupsOfTile * kGroupsOfTile; ++group)
    trace_group(Warp(), scene, place, group, memory, result, result.facing, result.tested);
  return result;
}

}  // namespace fluxel::cuda

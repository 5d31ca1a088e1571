#pragma once

#include "visibility/cuda/trace_group.hpp"

namespace fluxel::cuda {

/// What the device makes of a tile, by the same code on the host, whose arrays the scene must have: to test
/// it.
template <class Scene>
[[nodiscard]] TileResult trace_on_host(const Scene& scene, const TilePlace& place) {
  TileResult result{};
  GroupMemory memory;
  PairCounts counts;
  for (std::uint32_t group = 0; group < kGroupsOfTile * kGroupsOfTile; ++group)
    trace_group(Warp(), scene, place, group, memory, result, counts);
  result.facing = counts.facing;
  result.tested = counts.tested;
  return result;
}

}  // namespace fluxel::cuda

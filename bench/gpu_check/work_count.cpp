#include "bench/gpu_check/work_count.hpp"

#include <cstdint>
#include <mutex>
#include <vector>

#include "bench/gpu_check/tiles.hpp"
#include "visibility/cuda/host_trace.hpp"

namespace fluxel::cuda::checks {

namespace {

/// A scene that counts what is done on it, by one thread.
struct CountingScene : TileScene {
  std::array<std::uint64_t, kKindsOfWork>* times;

  void count(Work work) const { ++(*times)[static_cast<std::size_t>(work)]; }
};

struct Operations {
  double in_single, in_double;
};

// Read off the code, for triangles where it matters.
constexpr Operations kOperations[kKindsOfWork] = {
    {66, 0},  // box_of_shaft: the box 12, its bounds 6, twelve planes of 4 each
    {350,
     0},  // patch_of_shaft: bounds 30, twelve planes and four corners of 4 each, its plane and margins 128
    {37, 0},  // box_of_ray: the box 12, three axes of 8 each, 1
    {88, 0},  // patch_of_ray: heights 20, three edges of 21 each, 5
    {0, 64},  // exact_patch: heights 19, the axis 6, three corners of 9 and three edges of 4 each
};
constexpr double kOfFacing = 15;

}  // namespace

WorkOfPair count_work(const SceneArrays& arrays, std::size_t tiles, unsigned threads) {
  std::array<std::uint64_t, kKindsOfWork> sum{};
  std::mutex mutex;
  const std::vector<TilePlace> places = spread_tiles(arrays.view().tiles, tiles);
  in_parallel(places.size(), threads, [&](std::size_t number) {
    std::array<std::uint64_t, kKindsOfWork> times{};
    (void)trace_on_host(CountingScene{arrays.view(), &times}, places[number]);
    const std::lock_guard lock(mutex);
    for (std::size_t kind = 0; kind < kKindsOfWork; ++kind) sum[kind] += times[kind];
  });
  constexpr double kPairsOfTile = double{kTile} * kTile;
  WorkOfPair work;
  work.single_operations = kOfFacing;
  for (std::size_t kind = 0; kind < kKindsOfWork; ++kind) {
    work.times[kind] = static_cast<double>(sum[kind]) / (kPairsOfTile * static_cast<double>(places.size()));
    work.single_operations += work.times[kind] * kOperations[kind].in_single;
    work.double_operations += work.times[kind] * kOperations[kind].in_double;
  }
  work.bytes = (sizeof(TilePlace) + sizeof(TileResult)) / kPairsOfTile;
  return work;
}

}  // namespace fluxel::cuda::checks

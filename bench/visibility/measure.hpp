#pragma once

#include <cstddef>
#include <cstdint>

#include "core/element.hpp"
#include "core/progress.hpp"
#include "scene/scene.hpp"

namespace fluxel::bench {

struct MeasureSettings {
  int repetitions = 3;
  std::size_t most_tiles = 1'300'000;  ///< that the engine traces: all up to 100,000 elements, else by chance
  std::size_t sample_tiles = 2048;     ///< for the raw rate and for the classical method
  bool classical = true;
};

/// One scene at one number of elements N, one thread. Times are medians of the repetitions. A rate of pairs
/// counts all N^2, since a matrix of N^2 bits is what a solve reads.
struct Measurement {
  std::size_t elements = 0;
  std::size_t tiles = 0;         ///< of the upper triangle
  std::size_t traced_tiles = 0;  ///< by the engine; times are scaled up where these are fewer
  double seconds = 0;            ///< of all tiles
  double pairs_per_second = 0;
  double rays_per_second = 0;      ///< rays that the engine still traces
  double raw_rays_per_second = 0;  ///< of the fastest plain loop
  double ratio = 0;         ///< pairs_per_second / raw_rays_per_second, the median of the repetitions' ratios
  double rays_a_pair = 0;   ///< of N^2
  double without_rays = 0;  ///< fraction of tiles
  double one_value = 0;     ///< fraction of tiles
  double bits_a_pair = 0;   ///< of a TileStore that owns all rows, overhead included
  double mixed_8 = 0;       ///< fraction of all 8 x 8 blocks
  double mixed_4 = 0;
  std::uint64_t differing = 0;   ///< visible pairs more or less than plain rays find, over the raw sample
  double classical_seconds = 0;  ///< of all tiles; 0: not measured
  double leaky_rays_per_second =
      0;  ///< raw rays without ROBUST, some of which slip through between triangles
};

/// Engine and raw packets take turns every 64 tiles, so that what disturbs the machine disturbs both; times
/// are the thread's own. Raw packets are traced by several plain loops, row by row and in blocks of 4 x 4
/// pairs, coherent and not, of which the fastest counts. They are prepared outside the time that is measured;
/// the classical method, which is the plain way with the elements as occluders, is timed with its choice of
/// pairs, as the engine is. The building of ray scenes is not timed.
[[nodiscard]] Measurement measure(const Scene& scene, const ElementMesh& mesh,
                                  const MeasureSettings& settings, Progress& progress);

}  // namespace fluxel::bench

#include "mpi_master/steps/wave_job.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "reference/sensor_blocks.hpp"

namespace fluxel {

MeasuredWave trace_wave(const Communicator& communicator, const Sensors& sensors, const Wave& wave,
                        int threads) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t blocks = (sensors.size() + SensorBlocks::kSize - 1) / SensorBlocks::kSize;
  const auto start_of = [&](std::size_t block) {
    return std::min(block * SensorBlocks::kSize, sensors.size());
  };
  const std::size_t first = blocks * rank / ranks, last = blocks * (rank + 1) / ranks;
  std::vector<Rgb> mine(start_of(last) - start_of(first));
  std::atomic<std::uint64_t> rays = 0;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(first, last, [&](std::size_t block) {
      const std::size_t from = start_of(block), to = start_of(block + 1);
      rays += measure_wave(sensors, wave, from, std::span(mine).subspan(from - start_of(first), to - from));
    });
  });
  MeasuredWave found{communicator.all_gather(std::span<const Rgb>(mine)), rays};
  communicator.all_sum(std::span(&found.rays, 1));
  return found;
}

}  // namespace fluxel

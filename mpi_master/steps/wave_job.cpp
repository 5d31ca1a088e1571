#include "mpi_master/steps/wave_job.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

namespace fluxel {

MeasuredWave trace_wave(const Communicator& communicator, const Sensors& sensors, const Wave& wave,
                        int threads) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t from = sensors.size() * rank / ranks;
  std::vector<Rgb> mine(sensors.size() * (rank + 1) / ranks - from);
  std::atomic<std::uint64_t> rays = 0;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    constexpr std::size_t kGrain = 32;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mine.size(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        rays += measure_wave(sensors, wave, from + range.begin(),
                                             std::span(mine).subspan(range.begin(), range.size()));
                      });
  });
  MeasuredWave found{communicator.all_gather(std::span<const Rgb>(mine)), rays};
  communicator.all_sum(std::span(&found.rays, 1));
  return found;
}

}  // namespace fluxel

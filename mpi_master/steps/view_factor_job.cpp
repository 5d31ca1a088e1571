#include "mpi_master/steps/view_factor_job.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <mutex>

namespace fluxel {

namespace {

struct RowEntry {
  std::uint64_t row;
  SurfaceExchange entry;
};

}  // namespace

std::vector<SurfaceExchange> exchange_of_surfaces(const Communicator& communicator, const FacePairs& pairs,
                                                  int threads, Progress& progress) {
  progress.begin("view factors");
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t mine = pairs.rows() > rank ? (pairs.rows() - rank - 1) / ranks + 1 : 0;
  std::vector<std::vector<SurfaceExchange>> lists(mine);
  std::uint64_t all_pairs = 0, done = 0;
  for (std::size_t k = 0; k < mine; ++k) all_pairs += pairs.pairs_of_row(rank + k * ranks);
  std::mutex reporting;
  const auto looked_at = [&](std::size_t count) {
    const std::lock_guard lock(reporting);
    done += count;
    progress.update(static_cast<double>(done), static_cast<double>(all_pairs), "");
  };
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, mine,
                      [&](std::size_t k) { lists[k] = pairs.examine_row(rank + k * ranks, looked_at); });
  });

  std::vector<RowEntry> entries;
  for (std::size_t k = 0; k < mine; ++k)
    for (const SurfaceExchange& entry : lists[k]) entries.push_back({rank + k * ranks, entry});
  std::vector<RowEntry> all = communicator.all_gather(std::span<const RowEntry>(entries));
  std::ranges::stable_sort(all, {}, &RowEntry::row);
  std::vector<SurfaceExchange> sums;
  sums.reserve(all.size());
  for (const RowEntry& entry : all) sums.push_back(entry.entry);
  progress.end();
  return sum_by_surfaces(std::move(sums));
}

}  // namespace fluxel

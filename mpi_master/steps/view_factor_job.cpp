#include "mpi_master/steps/view_factor_job.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstdint>
#include <cstring>
#include <mutex>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

namespace fluxel {

namespace {

static_assert(std::is_trivially_copyable_v<SurfaceExchange>);

/// All rows' lists on the root, in order; none on the others.
std::vector<std::vector<SurfaceExchange>> gather_rows(const Communicator& communicator, std::size_t rows,
                                                      std::vector<std::vector<SurfaceExchange>> mine) {
  if (communicator.size() == 1) return mine;
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  std::vector<std::vector<SurfaceExchange>> all(communicator.is_root() ? rows : 0);
  for (std::size_t k = 0; k < mine.size(); ++k) {
    const std::size_t row = rank + k * ranks;
    if (communicator.is_root()) {
      all[row] = std::move(mine[k]);
      continue;
    }
    const auto bytes = std::as_bytes(std::span<const SurfaceExchange>(mine[k]));
    communicator.send(0, static_cast<int>(row), Bytes(bytes.begin(), bytes.end()));
    mine[k] = {};
  }
  communicator.receive_all([&](const Message& message) {
    std::vector<SurfaceExchange>& list = all[static_cast<std::size_t>(message.tag)];
    list.resize(message.data.size() / sizeof(SurfaceExchange));
    if (!list.empty()) std::memcpy(list.data(), message.data.data(), message.data.size());
  });
  return all;
}

}  // namespace

SurfaceExchanges exchange_of_surfaces(const Communicator& communicator, const FacePairs& pairs, int threads,
                                      Progress& progress) {
  progress.begin("view factors");
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t mine = pairs.rows() > rank ? (pairs.rows() - rank - 1) / ranks + 1 : 0;
  std::vector<std::vector<SurfaceExchange>> lists(mine);
  std::vector<std::uint64_t> rays(mine, 0);
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
    tbb::parallel_for(std::size_t{0}, mine, [&](std::size_t k) {
      SurfaceExchanges row = pairs.examine_row(rank + k * ranks, looked_at);
      lists[k] = std::move(row.list);
      rays[k] = row.rays;
    });
  });

  SurfaceExchanges all{merge_sums(gather_rows(communicator, pairs.rows(), std::move(lists))),
                       std::reduce(rays.begin(), rays.end())};
  communicator.all_sum(std::span(&all.rays, 1));
  progress.end();
  return all;
}

}  // namespace fluxel

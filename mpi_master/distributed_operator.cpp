#include "mpi_master/distributed_operator.hpp"

#include <algorithm>
#include <chrono>

namespace fluxel {

namespace {

/// Of a rank's rows. What is left to wait for is the last one.
constexpr std::size_t kMostParts = 8;

/// In a part, so that none of the threads idles for long at its end.
constexpr std::size_t kLeastTileRowsPerThread = 8;

}  // namespace

DistributedOperator::DistributedOperator(const Communicator& communicator, RowOperator& rows,
                                         std::size_t elements, bool two_sided, int threads)
    : communicator_(communicator), rows_(rows), elements_(elements), sides_(two_sided ? 2 : 1) {
  const TileRows mine = rows.owned();
  of_ranks_ = communicator.all_gather(std::span(&mine, 1));
  // The same on all ranks, since parts are gathered together.
  std::uint64_t parts = mine.size() / (kLeastTileRowsPerThread * static_cast<std::size_t>(threads));
  communicator.all_min(std::span(&parts, 1));
  parts_ = std::clamp<std::size_t>(parts, 1, kMostParts);
}

void DistributedOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) { apply_to(x, H); }
void DistributedOperator::apply(std::span<const double> x, std::span<double> H) { apply_to(x, H); }

void DistributedOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  sweep_over(E, rho, x);
}
void DistributedOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  sweep_over(E, rho, x);
}

template <class Value>
void DistributedOperator::apply_to(std::span<const Value> x, std::span<Value> H) {
  if (communicator_.size() == 1) return rows_.apply(x, H);
  rows_.start(x);
  for (std::size_t part = 0; part < parts_; ++part) {
    rows_.apply_rows(part_of(rows_.owned(), part, parts_), H);
    start_gather(H, part, parts_);
    communicator_.advance_gathers();
  }
  finish_gather<Value>();
}

template <class Value>
void DistributedOperator::sweep_over(std::span<const Value> E, std::span<const Value> rho,
                                     std::span<Value> x) {
  rows_.sweep(E, rho, x);
  if (communicator_.size() == 1) return;
  start_gather(x, 0, 1);
  finish_gather<Value>();
}

TileRows DistributedOperator::part_of(const TileRows& rows, std::size_t part, std::size_t parts) const {
  return {rows.first + rows.size() * part / parts, rows.first + rows.size() * (part + 1) / parts};
}

template <class Value>
void DistributedOperator::start_gather(std::span<Value> values, std::size_t part, std::size_t parts) {
  std::vector<ItemRange> ranges;
  for (const TileRows& of_rank : of_ranks_) {
    const TileRows rows = part_of(of_rank, part, parts);
    const std::size_t first = std::min(rows.first * kTileSize, elements_);
    ranges.push_back({first, std::min(rows.last * kTileSize, elements_) - first});
  }
  for (std::size_t side = 0; side < sides_; ++side)
    communicator_.start_gather(values.subspan(side * elements_, elements_),
                               std::span<const ItemRange>(ranges));
}

template <class Value>
void DistributedOperator::finish_gather() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  communicator_.finish_gathers();
  gathered_.wait_seconds += std::chrono::duration<double>(Clock::now() - start).count();
  const std::size_t mine = rows_.last_row() - rows_.first_row();
  gathered_.bytes += sides_ * (elements_ - mine) * sizeof(Value);
  ++gathered_.gathers;
}

}  // namespace fluxel

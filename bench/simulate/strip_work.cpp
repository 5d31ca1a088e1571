#include "bench/simulate/strip_work.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mpi_master/communication/row_parts.hpp"

namespace fluxel::bench {

namespace {

constexpr double kMinStripSeconds = 4e-3;  // as in mpi_master/visibility_job.cpp
constexpr double kPartBytes = 24;          // of the header of a row's part in a message
constexpr double kTagBytes = 1;            // of a tile

/// A number from the standard normal distribution that belongs to the key (SplitMix64, then Box & Muller).
double normal_of(std::uint64_t key) {
  const auto mix = [](std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30u)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27u)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31u);
  };
  const auto uniform = [&](std::uint64_t x) { return (static_cast<double>(mix(x) >> 11u) + 0.5) * 0x1p-53; };
  return std::sqrt(-2 * std::log(uniform(2 * key))) * std::cos(2 * std::numbers::pi * uniform(2 * key + 1));
}

}  // namespace

void DeliveryBook::add(int target, double tiles, double bytes) {
  std::size_t& place = place_[static_cast<std::size_t>(target)];
  if (place == kNone) {
    place = deliveries_.size();
    deliveries_.push_back({target, 0, 0});
  }
  deliveries_[place].tiles += tiles;
  deliveries_[place].bytes += bytes;
}

std::vector<Delivery> DeliveryBook::take() {
  for (const Delivery& delivery : deliveries_) place_[static_cast<std::size_t>(delivery.target)] = kNone;
  return std::exchange(deliveries_, {});
}

StripWork::StripWork(const TracedScene& scene, const RowOwners& owners)
    : scene_(scene),
      triangle_(scene.map.side()),
      owners_(owners),
      scheduler_(owners_, scene.costs.trace, kMinStripSeconds),
      book_(owners.ranks()) {}

Batch StripWork::compute(const TileRange& tiles) {
  TileSums all;
  // As VisibilityWork::deliver does: whole parts to the owner of the row, pieces to those of the columns.
  for (const RowPart& part : row_parts(triangle_, tiles)) {
    const TileSums sums = scene_.map.sums(part.row, part.first, part.last);
    all.seconds += sums.seconds;
    all.variance += sums.variance;
    const int row_owner = owners_.owner(part.row);
    const auto hand_over = [&](int target, std::size_t first, std::size_t last) {
      const auto count = static_cast<double>(last - first);
      book_.add(target, count, kPartBytes + kTagBytes * count + scene_.map.sums(part.row, first, last).bytes);
    };
    hand_over(row_owner, part.first, part.last);
    for (std::size_t first = part.first; first < part.last;) {
      const int column_owner = owners_.owner(first);
      const std::size_t last = std::min(part.last, owners_.rows(column_owner).last);
      if (column_owner != row_owner) hand_over(column_owner, first, last);
      first = last;
    }
  }
  // The tiles of a block differ: a batch takes more or less than its share of the mean.
  const double spread = std::sqrt(all.variance) * normal_of(tiles.first);
  return {std::max(0.2 * all.seconds, all.seconds + spread), book_.take()};
}

}  // namespace fluxel::bench

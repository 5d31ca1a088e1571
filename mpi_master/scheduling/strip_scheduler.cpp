#include "mpi_master/scheduling/strip_scheduler.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace fluxel {

namespace {

/// A strip is this part of a rank's even share of what is left (Polychronopoulos & Kuck, Guided
/// self-scheduling, 1987, with a factor): a rank of a tenth of the others' speed still ends with them, and
/// strips are few enough that messages do not matter.
constexpr double kStripsPerShare = 16;

/// What is done first shall tell how long the rest takes, though predicted costs may all be off by a factor
/// in one part of the matrix: all ranks together take it in so many pieces, in an order that is spread evenly
/// from the first pieces on. A rank has not fewer than kMinPieces, and none costs less than kMinPieceCost
/// strips.
constexpr double kPieces = 512, kMinPieces = 8, kMinPieceCost = 4;

/// 0 .. count - 1 by their binary digits in reverse (van der Corput), so that every beginning is spread
/// evenly.
std::vector<std::size_t> spread_order(std::size_t count) {
  const std::size_t digits = count > 1 ? std::bit_width(count - 1) : 0;
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < std::size_t{1} << digits; ++k) {
    std::size_t reversed = 0;
    for (std::size_t digit = 0; digit < digits; ++digit) reversed = 2 * reversed + (k >> digit & 1u);
    if (reversed < count) order.push_back(reversed);
  }
  return order;
}

}  // namespace

StripScheduler::StripScheduler(const RowOwners& owners, std::span<const double> row_costs, double min_cost,
                               std::span<const TileRange> done)
    : StripScheduler(owners, row_costs,
                     std::vector<double>(static_cast<std::size_t>(owners.ranks()), min_cost), done) {}

StripScheduler::StripScheduler(const RowOwners& owners, std::span<const double> row_costs,
                               std::vector<double> min_costs, std::span<const TileRange> done)
    : triangle_(row_costs.size()),
      min_costs_(std::move(min_costs)),
      all_min_costs_(std::reduce(min_costs_.begin(), min_costs_.end())),
      before_(row_costs.size() + 1),
      left_(static_cast<std::size_t>(owners.ranks())) {
  std::partial_sum(row_costs.begin(), row_costs.end(), before_.begin() + 1);
  std::uint64_t first = 0;
  for (const TileRange& range : done) {
    add({first, range.first}, owners);
    first = range.last;
  }
  add({first, triangle_.size()}, owners);
  for (std::size_t owner = 0; owner < left_.size(); ++owner) {
    cost_to_assign_ += left_[owner].cost;
    scatter(left_[owner]);
    if (!left_[owner].ranges.empty()) noted_.push({left_[owner].cost, owner});
  }
  cost_left_ = cost_to_assign_;
}

void StripScheduler::add(const TileRange& range, const RowOwners& owners) {
  for (std::uint64_t first = range.first; first < range.last;) {
    const int owner = owners.owner(triangle_.row_of(first));
    const TileRange part{first, std::min(range.last, triangle_.first_of(owners.rows(owner).last))};
    Share& share = left_[static_cast<std::size_t>(owner)];
    share.ranges.push_back(part);
    share.cost += cost(part);
    tiles_to_assign_ += part.size();
    first = part.last;
  }
}

void StripScheduler::scatter(Share& share) {
  const double pieces_wanted = std::max(kMinPieces, kPieces / static_cast<double>(left_.size()));
  const double min_cost = all_min_costs_ / static_cast<double>(left_.size());
  const double piece_cost = std::max(kMinPieceCost * min_cost, share.cost / pieces_wanted);
  std::vector<TileRange> pieces;
  for (TileRange range : share.ranges) {
    while (cost(range) > 1.5 * piece_cost) {
      // Up to the end of a row: what a row costs is known better than where in it, since near tiles come
      // first.
      const std::uint64_t within = number_at(cost_before(range.first) + piece_cost);
      const std::size_t last_row = triangle_.row_of(std::max(within, range.first + 1) - 1);
      const std::uint64_t end = triangle_.first_of(last_row + 1);
      pieces.push_back({range.first, std::min(end, range.last)});
      range.first = pieces.back().last;
    }
    if (range.size() > 0) pieces.push_back(range);
  }
  share.ranges.clear();
  for (const std::size_t k : spread_order(pieces.size())) share.ranges.push_back(pieces[k]);
}

std::optional<TileRange> StripScheduler::next(int rank) {
  Share* from = &left_[static_cast<std::size_t>(rank)];
  if (from->ranges.empty()) {
    from = richest();
    if (from == nullptr) return std::nullopt;
  }
  TileRange& range = from->ranges.front();
  const double min_cost = min_costs_[static_cast<std::size_t>(rank)];
  const double wanted = std::max(min_cost, cost_left_ / kStripsPerShare * (min_cost / all_min_costs_));
  const double start = cost_before(range.first);
  std::uint64_t last = std::clamp(number_at(start + wanted), range.first + 1, range.last);
  // Rather a little more than a rest that is not worth a message.
  if (cost_before(range.last) - cost_before(last) < min_cost / 2) last = range.last;

  const TileRange strip{range.first, last};
  const double cost = cost_before(last) - start;
  range.first = last;
  from->cost -= cost;
  if (range.size() == 0) from->ranges.pop_front();
  cost_left_ -= cost;
  tiles_assigned_ += strip.size();
  return strip;
}

void StripScheduler::set_min_cost(int rank, double min_cost) {
  min_costs_[static_cast<std::size_t>(rank)] = min_cost;
  all_min_costs_ = std::reduce(min_costs_.begin(), min_costs_.end());
}

/// The owner that has most left, or none. Notes are brought up to date when they come to the top, since with
/// thousands of ranks there are thousands of strips a second.
StripScheduler::Share* StripScheduler::richest() {
  while (!noted_.empty()) {
    const Noted top = noted_.top();
    Share& share = left_[top.owner];
    if (!share.ranges.empty() && share.cost == top.cost) return &share;
    noted_.pop();
    if (!share.ranges.empty()) noted_.push({share.cost, top.owner});
  }
  return nullptr;
}

double StripScheduler::cost_before(std::uint64_t number) const {
  const std::size_t row = triangle_.row_of(number);
  if (row == triangle_.side()) return before_.back();
  const auto in_row = static_cast<double>(number - triangle_.first_of(row));
  return before_[row] +
         (before_[row + 1] - before_[row]) * in_row / static_cast<double>(triangle_.side() - row);
}

std::uint64_t StripScheduler::number_at(double cost_before) const {
  if (cost_before >= before_.back()) return triangle_.size();
  const auto row =
      static_cast<std::size_t>(std::ranges::upper_bound(before_, cost_before) - before_.begin()) - 1;
  const double share = (cost_before - before_[row]) / (before_[row + 1] - before_[row]);
  return triangle_.first_of(row) +
         static_cast<std::uint64_t>(share * static_cast<double>(triangle_.side() - row));
}

}  // namespace fluxel

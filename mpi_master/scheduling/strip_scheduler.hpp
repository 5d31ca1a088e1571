#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include "mpi_master/scheduling/row_owners.hpp"
#include "visibility/tile_range.hpp"

namespace fluxel {

/// Strips are not made smaller than this [s on all threads of a rank]: a few batches.
inline constexpr double kMinStripSeconds = 4e-3;

/// Rank 0's decisions: which strip, consecutive tiles of the upper triangle, a rank computes next. Knows
/// nothing of messages and clocks.
class StripScheduler {
 public:
  /// `row_costs`: predicted seconds of processor time of the tiles (row, column >= row) of each row;
  /// `min_costs`: what is not worth splitting any more for each rank, in proportion to its speed [s];
  /// `done`: tiles that need no computing, ascending and disjoint.
  StripScheduler(const RowOwners& owners, std::span<const double> row_costs, std::vector<double> min_costs,
                 std::span<const TileRange> done = {});
  /// For equal ranks.
  StripScheduler(const RowOwners& owners, std::span<const double> row_costs, double min_cost,
                 std::span<const TileRange> done = {});

  /// The next strip for a rank that has nothing to do: of its own rows, whose tiles need not all travel, else
  /// of those of the rank that has most left. Rows come in an order in which every part of them is begun
  /// early. Its cost is the rank's share of all that is left, by its speed, so that strips begin large and
  /// shrink, and ranks end together however fast they are. Nothing when all is assigned.
  [[nodiscard]] std::optional<TileRange> next(int rank);

  /// A rank's speed has become another one: see min_costs of the constructor.
  void set_min_cost(int rank, double min_cost);

  /// Predicted, of a strip or a part of one [s].
  [[nodiscard]] double cost(const TileRange& tiles) const {
    return cost_before(tiles.last) - cost_before(tiles.first);
  }
  /// Of all that there was to assign.
  [[nodiscard]] double cost_to_assign() const { return cost_to_assign_; }

  [[nodiscard]] std::uint64_t tiles_assigned() const { return tiles_assigned_; }
  [[nodiscard]] std::uint64_t tiles_to_assign() const { return tiles_to_assign_; }

 private:
  /// An owner's tiles that nobody has yet.
  struct Share {
    std::deque<TileRange> ranges;
    double cost = 0;
  };
  /// What an owner had left when this was noted; it has no more now.
  struct Noted {
    double cost;
    std::size_t owner;
    bool operator<(const Noted& other) const { return cost < other.cost; }
  };

  void add(const TileRange& range, const RowOwners& owners);
  void scatter(Share& share);
  [[nodiscard]] Share* richest();
  [[nodiscard]] double cost_before(std::uint64_t number) const;
  [[nodiscard]] std::uint64_t number_at(double cost_before) const;

  TileTriangle triangle_;
  std::vector<double> min_costs_;  // by rank
  double all_min_costs_;
  std::vector<double> before_;        // cost of all rows before each, and of all
  std::vector<Share> left_;           // by owner
  std::priority_queue<Noted> noted_;  // every owner that has some left, once
  double cost_left_ = 0, cost_to_assign_ = 0;
  std::uint64_t tiles_to_assign_ = 0;
  std::uint64_t tiles_assigned_ = 0;
};

}  // namespace fluxel

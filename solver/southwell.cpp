#include <algorithm>
#include <numeric>

#include "solver/iteration.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

namespace {

/// Of the power not yet shot, in the tiles that an iteration shoots.
constexpr double kShare = 0.5;

template <class Value>
class Southwell final : public Iteration<Value> {
 public:
  Southwell(const LinearSystem<Value>& system, std::span<const Value> start)
      : system_(system),
        elements_(system.elements),
        first_tile_(tiles_before()),
        shot_(start.begin(), start.end()),
        unshot_(start.size()),
        sent_(start.size()),
        H_(start.size()),
        B_(start.begin(), start.end()) {}

  void advance() override {
    if (first_) {
      // Whatever the start holds is shot at once: mostly the emitters, a few tiles.
      apply_to(shot_);
      system_.residual_of(shot_, H_, unshot_);
      first_ = false;
    } else {
      take_brightest();
      apply_to(sent_);
      for (std::size_t i = 0; i < H_.size(); ++i) unshot_[i] += system_.rho[i] * H_[i];
    }
    for (std::size_t i = 0; i < B_.size(); ++i) B_[i] = shot_[i] + unshot_[i];
  }

  [[nodiscard]] std::span<const Value> radiosity() const override { return B_; }
  [[nodiscard]] std::span<const Value> change() const override { return unshot_; }
  [[nodiscard]] ChangeKind change_kind() const override { return ChangeKind::step; }
  /// Sums of many small shots.
  [[nodiscard]] bool change_is_exact() const override { return false; }
  void restart(std::span<const Value> B, std::span<const Value> residual) override {
    shot_.assign(B.begin(), B.end());
    unshot_.assign(residual.begin(), residual.end());
  }

 private:
  void apply_to(const std::vector<Value>& x) {
    system_.F.apply(std::span<const Value>(x), std::span<Value>(H_));
  }

  /// Of the ranks before this one.
  [[nodiscard]] std::size_t tiles_before() const {
    const Ranks& ranks = system_.F.ranks();
    const std::size_t own = tile_count(elements_);
    const std::vector<std::size_t> of_ranks = ranks.gather(std::span(&own, 1));
    return std::accumulate(of_ranks.begin(), of_ranks.begin() + static_cast<std::ptrdiff_t>(ranks.rank),
                           std::size_t{0});
  }

  /// Moves the unshot light of the brightest tiles of all ranks to sent_ and shot_.
  void take_brightest() {
    const std::vector<double> power = system_.F.ranks().gather(std::span<const double>(own_power()));
    std::vector<std::size_t> order(power.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t tile) { return power[tile]; });
    const double wanted = kShare * std::accumulate(power.begin(), power.end(), 0.0);
    std::ranges::fill(sent_, Value(0));
    double taken = 0;
    for (const std::size_t tile : order) {
      if (taken >= wanted) break;
      taken += power[tile];
      if (tile < first_tile_ || tile - first_tile_ >= tile_count(elements_)) continue;
      for_each_unknown(tile - first_tile_, [&](std::size_t i) {
        sent_[i] = unshot_[i];
        shot_[i] += unshot_[i];
        unshot_[i] = Value(0);
      });
    }
  }

  /// Power not yet shot from the sides of each own tile's elements, summed over the channels [W].
  [[nodiscard]] std::vector<double> own_power() const {
    std::vector<double> power(tile_count(elements_), 0);
    for (std::size_t tile = 0; tile < power.size(); ++tile)
      for_each_unknown(tile, [&](std::size_t i) {
        for (int c = 0; c < kChannelsOf<Value>; ++c)
          power[tile] += system_.area[i] * std::abs(channel(unshot_[i], c));
      });
    return power;
  }

  /// Of an own tile.
  template <class Function>
  void for_each_unknown(std::size_t tile, const Function& function) const {
    const std::size_t first = tile * kTileSize;
    for (std::size_t side = 0; side < system_.size(); side += elements_)
      for (std::size_t r = 0; r < rows_of_tile(tile, elements_); ++r) function(side + first + r);
  }

  const LinearSystem<Value>& system_;
  std::size_t elements_;
  std::size_t first_tile_;  // of the own ones
  std::vector<Value> shot_, unshot_, sent_, H_, B_;
  bool first_ = true;
};

}  // namespace

template <class Value>
std::unique_ptr<Iteration<Value>> make_southwell(const LinearSystem<Value>& system,
                                                 std::span<const Value> start) {
  return std::make_unique<Southwell<Value>>(system, start);
}

template std::unique_ptr<Iteration<double>> make_southwell(const LinearSystem<double>&,
                                                           std::span<const double>);
template std::unique_ptr<Iteration<Rgb>> make_southwell(const LinearSystem<Rgb>&, std::span<const Rgb>);

}  // namespace fluxel

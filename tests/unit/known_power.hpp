#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "solver/pair_kernel.hpp"
#include "solver/row_operator.hpp"

namespace fluxel::test_scenes {

/// For an operator that has some of the rows: what other ranks would set of a vector x that is known here.
class KnownPower final : public PowerExchange {
 public:
  /// `x` has an entry for each unknown of all elements.
  KnownPower(std::span<const Element> elements, const TileRows& owned, std::vector<Rgb> x)
      : columns_(elements),
        owned_(owned),
        x_(std::move(x)),
        room_(columns_.tiles.size(), x_.size() / elements.size()) {
    ranks_.max = [this](std::span<double> values) {
      for (const Rgb& value : x_) values[0] = std::max({values[0], value.r, value.g, value.b});
    };
  }

  [[nodiscard]] const Ranks& ranks() const override { return ranks_; }
  [[nodiscard]] SentPower room(std::size_t channels) override { return room_.room(channels); }
  void exchange(SentPower& sent) override {
    std::vector<double> most{0};
    ranks_.max(most);
    const double unit = std::ldexp(1.0, std::ilogb(most[0]));
    for (std::size_t k = 0; k < x_.size(); ++k) {
      const std::size_t i = k % columns_.area.size(), tile = i / kTileSize;
      if (owned_.contains(tile)) continue;
      for (std::size_t c = 0; c < sent.power.channels(); ++c) {
        const double disc = static_cast<double>(columns_.area[i]) * std::numbers::inv_pi;
        const std::size_t side = k / columns_.area.size();
        const double exact = disc * (x_[k][static_cast<int>(c)] / unit);
        float& power = sent.power.of(tile, side, c)[i % kTileSize];
        power = static_cast<float>(exact);
        sent.rest.of(tile, side, c)[i % kTileSize] = static_cast<float>(exact - static_cast<double>(power));
      }
      if (x_[k] != Rgb(0)) sent.sends[tile] = 1;
    }
  }

 private:
  PairColumns columns_;
  TileRows owned_;
  std::vector<Rgb> x_;
  LocalPower room_;
  Ranks ranks_;
};

/// The unknowns of some tile rows among those of all elements.
[[nodiscard]] inline std::vector<std::size_t> unknowns_of(const TileRows& rows, std::size_t elements,
                                                          std::size_t unknowns) {
  std::vector<std::size_t> of_rows;
  for (std::size_t side = 0; side < unknowns; side += elements)
    for (std::size_t i = rows.first * kTileSize; i < std::min(elements, rows.last * kTileSize); ++i)
      of_rows.push_back(side + i);
  return of_rows;
}

/// F x of the rows that `store` owns, into their entries of `H`. Both have an entry for each unknown.
inline void apply_owned_rows(RowOperator& F, const TileStore& store, std::span<const Element> elements,
                             const std::vector<Rgb>& x, std::vector<Rgb>& H) {
  KnownPower power(elements, store.owned(), x);
  F.use(power);
  const std::vector<std::size_t> own = unknowns_of(store.owned(), elements.size(), x.size());
  std::vector<Rgb> own_x, own_H(own.size());
  for (const std::size_t k : own) own_x.push_back(x[k]);
  F.apply(own_x, own_H);
  for (std::size_t k = 0; k < own.size(); ++k) H[own[k]] = own_H[k];
}

}  // namespace fluxel::test_scenes

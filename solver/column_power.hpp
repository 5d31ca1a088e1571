#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ranks.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

/// A number for each column of a tile.
using TileFloats = std::array<float, kTileSize>;

/// A_j B_j / pi, with A_j as in PairColumns, in single precision for each channel, of fronts and (in
/// two-sided scenes) backs, 0 for padding.
class ColumnPower {
 public:
  struct alignas(64) Line {
    TileFloats of{};
  };

  /// All 0.
  ColumnPower(std::size_t tiles, std::size_t sides, std::size_t channels)
      : sides_(sides), channels_(channels), own_(tiles * sides * channels), lines_(own_) {}
  /// In lines that are held elsewhere, and outlive this.
  ColumnPower(std::span<Line> lines, std::size_t sides, std::size_t channels)
      : sides_(sides), channels_(channels), lines_(lines) {}
  ~ColumnPower() = default;
  ColumnPower(ColumnPower&&) = default;
  ColumnPower& operator=(ColumnPower&&) = default;
  ColumnPower(const ColumnPower&) = delete;
  ColumnPower& operator=(const ColumnPower&) = delete;

  [[nodiscard]] std::size_t channels() const { return channels_; }
  [[nodiscard]] TileFloats& of(std::size_t tile, std::size_t side, std::size_t channel) {
    return lines_[line_of(tile, side, channel)].of;
  }
  [[nodiscard]] const TileFloats& of(std::size_t tile, std::size_t side, std::size_t channel) const {
    return lines_[line_of(tile, side, channel)].of;
  }
  /// Those of the tile's sides and channels stand one after another.
  [[nodiscard]] const float* of(std::size_t tile) const { return lines_[line_of(tile, 0, 0)].of.data(); }

  [[nodiscard]] std::span<Line> lines() { return lines_; }
  [[nodiscard]] std::span<Line> lines_of(std::size_t tile) {
    return lines_.subspan(line_of(tile, 0, 0), sides_ * channels_);
  }

 private:
  [[nodiscard]] std::size_t line_of(std::size_t tile, std::size_t side, std::size_t channel) const {
    return (tile * sides_ + side) * channels_ + channel;
  }

  std::size_t sides_, channels_;
  std::vector<Line> own_;
  std::span<Line> lines_;
};

/// What the columns send in a product.
struct SentPower {
  ColumnPower power;
  ColumnPower rest;               ///< what single precision left off of it: both together have 48 bits
  std::span<std::uint8_t> sends;  ///< an entry a tile: 0 where nothing of it has any power
};

/// Where the power of all columns is held, of which each rank sets that of its own tiles.
class PowerExchange {
 public:
  PowerExchange() = default;
  virtual ~PowerExchange() = default;
  PowerExchange(const PowerExchange&) = delete;
  PowerExchange& operator=(const PowerExchange&) = delete;

  [[nodiscard]] virtual const Ranks& ranks() const = 0;

  /// Room for so many channels, with anything in it. It is the same each time: to be asked for when all ranks
  /// have met after the product before, as for the largest x.
  [[nodiscard]] virtual SentPower room(std::size_t channels) = 0;

  /// By all ranks together: what each has set for its own tiles in its last room, all find there.
  virtual void exchange(SentPower& sent) = 0;
};

/// Of a rank that has all tiles.
class LocalPower final : public PowerExchange {
 public:
  LocalPower(std::size_t tiles, std::size_t sides) : sides_(sides), sends_(tiles) {}

  [[nodiscard]] const Ranks& ranks() const override { return ranks_; }
  [[nodiscard]] SentPower room(std::size_t channels) override {
    const std::size_t lines = sends_.size() * sides_ * channels;
    lines_.resize(2 * lines);
    const std::span<ColumnPower::Line> all = lines_;
    return {ColumnPower(all.first(lines), sides_, channels), ColumnPower(all.last(lines), sides_, channels),
            sends_};
  }
  void exchange(SentPower& /*sent*/) override {}

 private:
  Ranks ranks_;
  std::size_t sides_;
  std::vector<ColumnPower::Line> lines_;
  std::vector<std::uint8_t> sends_;
};

}  // namespace fluxel

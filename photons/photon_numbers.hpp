#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/portable_sampling.hpp"
#include "core/sensor_estimate.hpp"
#include "sampling/halton.hpp"
#include "sampling/owen_sobol.hpp"
#include "sampling/random_sequence.hpp"
#include "sampling/sobol.hpp"

namespace fluxel {

// The points by which photons go. Each has a number of parts, to which photons belong by their index, such
// that every part alone comes to the right light; their differences tell the error. `start` begins the point
// of an index and says to which part it belongs; `next` is the next coordinate, in [0, 1), up to
// kDimensions.

/// Which half a point of a plain sequence belongs to, and its first coordinate from then on. Even and odd
/// indices would not do: the first coordinate of all even points is below a half (Dmitriev 2002, algorithm
/// 1).
struct HalvedCoordinate {
  std::size_t half;
  double coordinate;
};

[[nodiscard]] inline HalvedCoordinate halved(double q) {
  if (q >= 0.5) return {1, 2 * q - 1};
  const double moved = 2 * q + 1.0 / 3;
  return {0, moved < 1 ? moved : moved - 1};
}

/// Plain sequences begin with the point of this index. The point of index 0 has coordinates of 0 alone, of
/// which choices leave 0: such a photon would hardly ever be absorbed. A sequence in base 2 is as even from
/// here on, as far as to twice this, as from 0 on.
inline constexpr std::uint64_t kFirstPlainPoint = std::uint64_t{1} << 40;

/// Sobol's or Halton's sequence.
template <class Sequence>
class PlainPoints {
 public:
  static constexpr std::size_t kParts = 2;
  static constexpr std::size_t kDimensions = Sequence::kDimensions;

  explicit PlainPoints(std::uint64_t /*seed*/) {}

  std::size_t start(std::uint64_t index) {
    sequence_.start(kFirstPlainPoint + index);
    const HalvedCoordinate of = halved(sequence_.next());
    first_ = of.coordinate;
    is_first_ = true;
    return of.half;
  }
  double next() {
    if (!is_first_) return sequence_.next();
    is_first_ = false;
    return first_;
  }

 private:
  Sequence sequence_;
  double first_ = 0;
  bool is_first_ = true;
};

/// Numbers that look random; even and odd photons.
class RandomPoints {
 public:
  static constexpr std::size_t kParts = 2;
  static constexpr std::size_t kDimensions = static_cast<std::size_t>(-1);

  explicit RandomPoints(std::uint64_t seed) : sequence_(seed) {}

  std::size_t start(std::uint64_t index) {
    sequence_.start(index);
    return index % kParts;
  }
  double next() { return sequence_.next(); }

 private:
  RandomSequence sequence_;
};

/// Independent randomisations of Sobol's sequence, which take turns.
class ScrambledPoints {
 public:
  static constexpr std::size_t kParts = kRandomisations;
  static constexpr std::size_t kDimensions = static_cast<std::size_t>(-1);

  explicit ScrambledPoints(std::uint64_t seed) : seed_(random_bits(seed)) {}

  std::size_t start(std::uint64_t index) {
    const std::size_t part = index % kParts;
    points_ = OwenSobol(random_bits(seed_ + part), static_cast<std::uint32_t>(index / kParts));
    at_ = group_.size();
    return part;
  }
  double next() {
    if (at_ == group_.size()) {
      group_ = points_.next();
      at_ = 0;
    }
    return group_[at_++];
  }

 private:
  std::uint64_t seed_;
  OwenSobol points_{0, 0};
  std::array<double, OwenSobol::kAxes> group_{};
  std::size_t at_ = 0;
};

/// The numbers of one photon after another. What a choice leaves of its number serves the next choice, so
/// that mirrors and clear glass take no coordinate (Dmitriev 2002, equation 13: at most those of the
/// emission, two each time that light is scattered evenly, and one where it is absorbed).
template <class Points>
class PhotonNumbers {
 public:
  static constexpr std::size_t kParts = Points::kParts;

  explicit PhotonNumbers(std::uint64_t seed) : points_(seed) {}

  /// Begins a photon; returns the part that it belongs to.
  std::size_t start(std::uint64_t index) {
    index_ = index;
    dimension_ = 0;
    has_kept_ = false;
    return points_.start(index);
  }

  /// In [0, 1): a coordinate of the point; beyond its dimensions one that looks random.
  double next() {
    ++drawn_;
    if (dimension_ < Points::kDimensions) {
      ++dimension_;
      return points_.next();
    }
    if (dimension_ == Points::kDimensions) {
      beyond_.start(index_);
      ++dimension_;
    }
    return beyond_.next();
  }

  /// As `next`, or what the last choice has left.
  double next_of_choice() {
    if (!has_kept_) return next();
    has_kept_ = false;
    return kept_;
  }
  void keep(double rest) {
    kept_ = rest;
    has_kept_ = true;
  }

  /// Coordinates, of all photons.
  [[nodiscard]] std::uint64_t drawn() const { return drawn_; }

 private:
  Points points_;
  RandomSequence beyond_;  // the same for every seed: plain points have none
  std::uint64_t index_ = 0, drawn_ = 0;
  std::size_t dimension_ = 0;
  double kept_ = 0;
  bool has_kept_ = false;
};

}  // namespace fluxel

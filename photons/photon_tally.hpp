#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "photons/tally_shape.hpp"

namespace fluxel {

/// Beside the slots.
enum class PhotonCount : std::size_t {
  sent,
  met,          ///< that have met a surface at all
  segments,     ///< of their paths: rays
  coordinates,  ///< of the points by which they went
  count
};

/// How a path ends: outside of the scene, in a surface, or still on its way after kMostSteps.
enum class PhotonFate : std::size_t { escaped, absorbed, lost, count };

/// After so many surfaces a photon is given up: between mirrors that absorb nothing it would never end.
inline constexpr std::uint64_t kMostSteps = 100'000;

/// What photons have brought, in whole numbers, which add up to the same in any order. May be added to from
/// many threads at once.
class PhotonTally {
 public:
  /// Of a photon's power.
  static constexpr double kUnits = 1 << 20;
  /// Photons that may be sent at all: of those a slot holds 62 bits, each bringing three of one colour.
  static constexpr std::uint64_t kMostPhotons = std::uint64_t{1} << 40;

  explicit PhotonTally(const TallyShape& shape);

  [[nodiscard]] const TallyShape& shape() const { return shape_; }

  /// Whether something is added or taken away: values may wrap around zero where both follow.
  enum class Sign { plus, minus };

  /// A photon of `colour`, of mean 1, has come to a slot.
  void add(std::size_t slot, std::size_t part, const Rgb& colour, Sign sign = Sign::plus) {
    add_to(place(slot, part), colour, sign);
  }
  /// A photon has brought that much to a cell in all; where the shape has squares.
  void add_square(std::size_t slot, const Rgb& sum) {
    add_to(squares_ + (slot - shape_.sides) * kChannels, sum * sum, Sign::plus);
  }
  /// A photon has ended so, with that colour.
  void add_end(PhotonFate fate, const Rgb& colour, Sign sign = Sign::plus) {
    add_to(place(fate), colour, sign);
  }
  void add(PhotonCount count, std::uint64_t number) {
    add_to(values_[static_cast<std::size_t>(count)], number);
  }
  void add_sent(std::size_t part, std::uint64_t number) { add_to(values_[parts_ + part], number); }
  /// Photons that have come to elements (0), or to a receiver, counted from 1.
  void add_received(std::size_t kind, std::uint64_t number) { add_to(values_[received_ + kind], number); }

  /// Of all photons of a part, in photons.
  [[nodiscard]] Rgb sum(std::size_t slot, std::size_t part) const { return photons(place(slot, part)); }
  [[nodiscard]] Rgb sum_of_squares(std::size_t slot) const {
    return photons(squares_ + (slot - shape_.sides) * kChannels);
  }
  [[nodiscard]] Rgb ended(PhotonFate fate) const { return photons(place(fate)); }
  [[nodiscard]] std::uint64_t count(PhotonCount of) const { return values_[static_cast<std::size_t>(of)]; }
  [[nodiscard]] std::uint64_t sent(std::size_t part) const { return values_[parts_ + part]; }
  [[nodiscard]] std::uint64_t received(std::size_t kind) const { return values_[received_ + kind]; }

  /// Takes what a tally of another shape, with as many parts and receivers, has: `slots` says where each of
  /// its slots is here, or that it is nowhere (the largest number).
  void take_over(const PhotonTally& other, std::span<const std::size_t> slots);

  /// Adds what another one of the same shape has, and leaves nothing there.
  void take(PhotonTally& other);

  /// All numbers, in an order that depends on the shape alone.
  [[nodiscard]] std::span<std::uint64_t> values() { return values_; }
  [[nodiscard]] std::span<const std::uint64_t> values() const { return values_; }
  [[nodiscard]] static std::size_t size_of(const TallyShape& shape);

  /// Whether all sums stay below 62 bits with so many photons more, which may bring twice what others have.
  [[nodiscard]] bool has_room_for(std::uint64_t photons) const;

 private:
  static void add_to(std::uint64_t& value, std::uint64_t more) {
    std::atomic_ref(value).fetch_add(more, std::memory_order_relaxed);
  }
  void add_to(std::size_t at, const Rgb& photons, Sign sign) {
    for (int c = 0; c < kChannels; ++c) {
      const std::uint64_t more = units(photons[c]);
      add_to(values_[at + static_cast<std::size_t>(c)], sign == Sign::plus ? more : 0 - more);
    }
  }
  [[nodiscard]] static std::uint64_t units(double photons) {
    return static_cast<std::uint64_t>(std::llround(photons * kUnits));
  }
  [[nodiscard]] static std::size_t place(PhotonFate fate) {
    return static_cast<std::size_t>(PhotonCount::count) + static_cast<std::size_t>(fate) * kChannels;
  }
  [[nodiscard]] std::size_t place(std::size_t slot, std::size_t part) const {
    return slots_ + (slot * shape_.parts + part) * kChannels;
  }
  [[nodiscard]] Rgb photons(std::size_t at) const {
    return Rgb(static_cast<double>(values_[at]), static_cast<double>(values_[at + 1]),
               static_cast<double>(values_[at + 2])) /
           kUnits;
  }

  TallyShape shape_;
  std::size_t parts_, received_, slots_, squares_;  // where each begins
  std::vector<std::uint64_t> values_;
};

}  // namespace fluxel

#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "formfactor/view_factor.hpp"

namespace fluxel {

/// Random bits of a seed (SplitMix64: Steele, Lea & Flood 2014).
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t state) {
  state += 0x9E3779B97F4A7C15ull;
  state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9ull;
  state = (state ^ (state >> 27)) * 0x94D049BB133111EBull;
  return state ^ (state >> 31);
}

/// Powers of 1/g, g the root of g^(n+1) = g + 1.
template <std::size_t n>
inline constexpr std::array<double, n> kEvenSteps{};
template <>
inline constexpr std::array<double, 3> kEvenSteps<3>{0.8191725133961645, 0.6710436067037893,
                                                     0.5497004779019703};
template <>
inline constexpr std::array<double, 4> kEvenSteps<4>{0.8566748838545029, 0.7338918566271260,
                                                     0.6287067210378087, 0.5385972572236101};

/// Points of the unit cube in n dimensions that fill it evenly however many are taken: Roberts' additive
/// recurrence (2018), from a start that the seed draws, so that sequences err independently (Cranley &
/// Patterson 1976).
template <std::size_t n>
class EvenSequence {
 public:
  explicit EvenSequence(std::uint64_t seed) {
    for (std::size_t axis = 0; axis < n; ++axis)
      place_[axis] = static_cast<double>(mix(seed + axis * 0xD1342543DE82EF95ull) >> 11) * 0x1p-53;
  }

  std::array<double, n> next() {
    const std::array<double, n> point = place_;
    for (std::size_t axis = 0; axis < n; ++axis) {
      place_[axis] += kEvenSteps<n>[axis];
      if (place_[axis] >= 1) place_[axis] -= 1;
    }
    return point;
  }

 private:
  std::array<double, n> place_;
};

/// A convex polygon as a fan of triangles, to draw its points evenly.
class PolygonFan {
 public:
  /// The polygon must outlive this.
  explicit PolygonFan(const SmallPolygon& corners);

  /// Area-preserving from the unit square.
  [[nodiscard]] glm::dvec3 point(double u, double v) const;

 private:
  const SmallPolygon& corners_;
  boost::container::small_vector<double, 8> ends_;  // of each triangle's share of the area
};

}  // namespace fluxel

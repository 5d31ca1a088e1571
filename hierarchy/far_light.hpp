#pragma once

#include <array>
#include <cstddef>

#include "core/rgb.hpp"
#include "formfactor/pair_rule.hpp"

namespace fluxel {

/// Points of one face and the light that they have got, one coordinate or colour an array.
struct PointGroup {
  static constexpr std::size_t kSize = 64;
  alignas(64) std::array<double, kSize> x{}, y{}, z{};           ///< [m]
  alignas(64) std::array<double, kSize> red{}, green{}, blue{};  ///< [W/m2], whole numbers of units
  glm::dvec3 normal{0};                                          ///< unit
  std::size_t count = 0;
};

/// Adds the light of a sender of radiosity B [W/m2] that nothing stands before, by PairRule::moments, rounded
/// for each point to a whole number of `unit`, a power of two: as long as sums stay below 2^53 units they are
/// the same in every order.
void add_far_light(const FlatShape& sender, const Rgb& B, double unit, PointGroup& points);

}  // namespace fluxel

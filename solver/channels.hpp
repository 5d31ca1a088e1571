#pragma once

#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <span>
#include <type_traits>

#include "core/rgb.hpp"

namespace fluxel {

// The solvers are written once, over values of one channel (double) or three (Rgb).

template <class Value>
inline constexpr int kChannelsOf = std::is_same_v<Value, Rgb> ? kChannels : 1;

[[nodiscard]] inline double channel(double value, int) { return value; }
[[nodiscard]] inline double channel(const Rgb& value, int c) { return value[c]; }

[[nodiscard]] inline Rgb widened(double value) { return Rgb(value); }
[[nodiscard]] inline Rgb widened(const Rgb& value) { return value; }

/// function(channel of each argument), channel by channel.
template <class Value, class Function>
[[nodiscard]] Value by_channel(const Function& function, const Value& a, const Value& b) {
  if constexpr (kChannelsOf<Value> == 1) {
    return function(a, b);
  } else {
    return {function(a.r, b.r), function(a.g, b.g), function(a.b, b.b)};
  }
}

[[nodiscard]] inline double largest_channel(double value) { return value; }
[[nodiscard]] inline double largest_channel(const Rgb& value) {
  return std::fmax(value.r, std::fmax(value.g, value.b));
}

/// sum A_i x_i / sum A_i, in the order of the entries.
template <class Value>
[[nodiscard]] Value area_mean(std::span<const double> area, std::span<const Value> x) {
  Value sum(0);
  double whole = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += area[i] * x[i];
    whole += area[i];
  }
  return whole > 0 ? sum / whole : Value(0);
}

/// Sum of the products in the order of the entries, so that it has the same bytes on every rank.
template <class Value>
[[nodiscard]] Value dot(std::span<const Value> x, std::span<const Value> y) {
  Value sum(0);
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

}  // namespace fluxel

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
[[nodiscard]] inline double& channel_of(double& value, int) { return value; }
[[nodiscard]] inline double& channel_of(Rgb& value, int c) { return value[c]; }

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

}  // namespace fluxel

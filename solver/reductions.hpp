#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "core/ranks.hpp"
#include "solver/channels.hpp"
#include "solver/exact_sum.hpp"

namespace fluxel {

// What is found out of vectors whose parts are on several ranks: by all of these together, with the same
// bytes for every number of them.

/// The sum of term(i) over the `size` entries of this rank's part and those of all other ranks.
template <class Value, class Term>
[[nodiscard]] Value sum_over(const Ranks& ranks, std::size_t size, const Term& term) {
  constexpr std::size_t kCount = kChannelsOf<Value>;
  std::array<std::uint64_t, kCount * ExactSum::kWords> words{};
  const auto sum_of = [&](int c) {
    return ExactSum(
        ExactSum::Words(words.data() + static_cast<std::size_t>(c) * ExactSum::kWords, ExactSum::kWords));
  };
  for (std::size_t i = 0; i < size; ++i) {
    const Value value = term(i);
    for (int c = 0; c < kChannelsOf<Value>; ++c) sum_of(c).add(channel(value, c));
  }
  ranks.sum(words);
  Value sum(0);
  for (int c = 0; c < kChannelsOf<Value>; ++c) channel_of(sum, c) = sum_of(c).value();
  return sum;
}

/// The largest of all ranks' values, channel by channel; not of what is no number.
template <class Value>
[[nodiscard]] Value largest_over(const Ranks& ranks, Value own) {
  std::array<double, kChannelsOf<Value>> channels;
  for (int c = 0; c < kChannelsOf<Value>; ++c) channels[static_cast<std::size_t>(c)] = channel(own, c);
  ranks.max(channels);
  for (int c = 0; c < kChannelsOf<Value>; ++c) channel_of(own, c) = channels[static_cast<std::size_t>(c)];
  return own;
}

/// sum x_i y_i.
template <class Value>
[[nodiscard]] Value dot(const Ranks& ranks, std::span<const Value> x, std::span<const Value> y) {
  return sum_over<Value>(ranks, x.size(), [&](std::size_t i) { return x[i] * y[i]; });
}

}  // namespace fluxel

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace fluxel {

/// A visible fraction with the standard error that independent randomisations show.
struct FractionEstimate {
  double value = 0;  ///< 0..1
  double error = 0;
  std::uint64_t samples = 0;  ///< of all sequences
};

inline constexpr std::size_t kSequences = 8;

/// The mean of eight independent sequences, each made longer, from `length` samples on, until the mean's
/// standard error is at most `wanted` or `most` samples are spent. A sequence has sample(), samples(),
/// agree() (all samples said visible, or all hidden) and visible(). Where n samples all agree, one in 2 n
/// might still have said otherwise.
template <class Sequence>
FractionEstimate estimate(std::array<Sequence, kSequences>& sequences, std::uint64_t length, double wanted,
                          std::uint64_t most) {
  // Of eight values the standard deviation is uncertain by a quarter, and stopping favours what looks small.
  constexpr double kCaution = 1.5;
  constexpr auto kCount = static_cast<double>(kSequences);
  FractionEstimate result;
  while (true) {
    double sum = 0, squares = 0;
    bool agree = true;
    result.samples = 0;
    for (Sequence& sequence : sequences) {
      while (sequence.samples() < length) sequence.sample();
      const double visible = sequence.visible();
      sum += visible;
      squares += visible * visible;
      agree = agree && sequence.agree();
      result.samples += sequence.samples();
    }
    result.value = sum / kCount;
    agree = agree && (sum == 0 || sum == kCount);
    const double variance = std::max(0.0, squares / kCount - result.value * result.value) / (kCount - 1);
    result.error = agree ? 0.5 / static_cast<double>(result.samples) : kCaution * std::sqrt(variance);
    if (result.error <= wanted || result.samples >= most) return result;
    length *= 2;
  }
}

}  // namespace fluxel

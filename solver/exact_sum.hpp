#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fluxel {

/// A sum of numbers that is rounded when it is read and not before, so that it is the same in every order and
/// for every distribution over ranks: a whole number of units of the smallest double, in digits to the base
/// 2^32 (Kulisch & Miranker 1986; the digits' spare bits for carries: Neal, Fast exact summation using small
/// and large superaccumulators, 2015). Up to 2^29 numbers.
class ExactSum {
 public:
  static constexpr std::size_t kWords = 68;
  /// The sum of two sums' words, modulo 2^64, is those of the sum of both.
  using Words = std::span<std::uint64_t, kWords>;

  /// In words that are all 0, and outlive this.
  explicit ExactSum(Words words) : words_(words) {}

  void add(double term);

  /// The sum, rounded to the nearest double; not a number where a term was not finite, infinite where
  /// it is too large for a double.
  [[nodiscard]] double value() const;

 private:
  // The last counts terms that are not finite. The others are digits, lowest first, in two's complement, that
  // have not been carried.
  Words words_;
};

}  // namespace fluxel

#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>

#include "sampling/halton.hpp"
#include "sampling/random_sequence.hpp"
#include "sampling/sobol.hpp"
#include "tests/plain_sequences.hpp"

namespace fluxel::bench {

// Ways to make points of five dimensions, one coordinate at a time, as a photon asks for them: the plain ones
// and others that HaltonSequence and SobolSequence are compared with.

inline constexpr std::size_t kDimensions = 5;

/// Calls `of<k>()` for a dimension that the compiler does not know.
template <class Of>
double of_dimension(std::size_t dimension, const Of& of) {
  switch (dimension) {
    case 0:
      return of.template operator()<2>();
    case 1:
      return of.template operator()<3>();
    case 2:
      return of.template operator()<5>();
    case 3:
      return of.template operator()<7>();
    default:
      return of.template operator()<11>();
  }
}

/// What all have.
class OneByOne {
 public:
  void start(std::uint64_t index) {
    index_ = index;
    dimension_ = 0;
  }

 protected:
  std::uint64_t index_ = 0;
  std::size_t dimension_ = 0;
};

/// Equations 5 and 6, in doubles: a division of 64 bits for each digit.
class PlainHalton : public OneByOne {
 public:
  double next() {
    const std::uint64_t base = HaltonSequence::bases()[dimension_++].base;
    const double step = 1 / static_cast<double>(base);
    double sum = 0, weight = step;
    for (std::uint64_t rest = index_; rest != 0; rest /= base, weight *= step)
      sum += weight * static_cast<double>(rest % base);
    return sum;
  }
};

/// The same with bases that the compiler knows, so that it divides by multiplying.
class PlainHaltonOfConstants : public OneByOne {
 public:
  double next() {
    return of_dimension(dimension_++, [this]<std::uint64_t Base>() {
      constexpr double kStep = 1.0 / Base;
      double sum = 0, weight = kStep;
      for (std::uint64_t rest = index_; rest != 0; rest /= Base, weight *= kStep)
        sum += weight * static_cast<double>(rest % Base);
      return sum;
    });
  }
};

/// A base as Dmitriev cuts indices.
struct CutBase {
  std::uint32_t base = 2, power = 2;  // base^k, the largest below 2^32
  double of_power = 0.5;

  static CutBase of(std::uint32_t base) {
    CutBase cut{base, base};
    while (std::uint64_t{cut.power} * base <= std::numeric_limits<std::uint32_t>::max()) cut.power *= base;
    cut.of_power = 1.0 / cut.power;
    return cut;
  }
};

inline const std::array kCutBases{CutBase::of(2), CutBase::of(3), CutBase::of(5), CutBase::of(7),
                                  CutBase::of(11)};

/// Equation 7: digits of 32 bits, the high ones kept.
class DecomposedHalton : public OneByOne {
 public:
  double next() {
    const CutBase& of = kCutBases[dimension_];
    Known& known = known_[dimension_++];
    const std::uint64_t high = index_ / of.power;
    if (high != known.high) {
      known.high = high;
      known.value = reversed(static_cast<std::uint32_t>(high), of.base) * of.of_power;
    }
    return reversed(static_cast<std::uint32_t>(index_ - high * of.power), of.base) + known.value;
  }

 private:
  struct Known {
    std::uint64_t high = 0;
    double value = 0;
  };

  static double reversed(std::uint32_t rest, std::uint32_t base) {
    const double step = 1.0 / base;
    double sum = 0, weight = step;
    for (; rest != 0; rest /= base, weight *= step) sum += weight * (rest % base);
    return sum;
  }

  std::array<Known, kDimensions> known_{};
};

/// The same, and the low part from that of an index below by less than the base: a step adds to the digit
/// that comes first, and carries to those behind. In whole numbers.
class RecurrentHalton : public OneByOne {
 public:
  double next() {
    const CutBase& of = kCutBases[dimension_];
    Known& known = known_[dimension_++];
    const std::uint64_t step = index_ - known.index;
    known.index = index_;
    if (step < of.base && known.low + step < of.power) {
      known.low += static_cast<std::uint32_t>(step);
      known.reversed = added(known.reversed, static_cast<std::uint32_t>(step), of);
    } else {
      const std::uint64_t high = index_ / of.power;
      if (high != known.high) {
        known.high = high;
        known.of_high = reversed(static_cast<std::uint32_t>(high), of) * of.of_power;
      }
      known.low = static_cast<std::uint32_t>(index_ - high * of.power);
      known.reversed = reversed(known.low, of);
    }
    return (known.reversed + known.of_high) * of.of_power;
  }

 private:
  struct Known {
    std::uint64_t index = 0, high = 0;
    std::uint32_t low = 0, reversed = 0;
    double of_high = 0;
  };

  static std::uint32_t added(std::uint32_t digits, std::uint32_t step, const CutBase& of) {
    std::uint32_t weight = of.power / of.base;
    const std::uint64_t sum = digits + std::uint64_t{step} * weight;
    if (sum < of.power) return static_cast<std::uint32_t>(sum);
    digits = static_cast<std::uint32_t>(sum - of.power);
    std::uint32_t rest = digits % weight;
    for (weight /= of.base; rest / weight == of.base - 1; weight /= of.base) {
      digits -= (of.base - 1) * weight;
      rest -= (of.base - 1) * weight;
    }
    return digits + weight;
  }

  static std::uint32_t reversed(std::uint32_t number, const CutBase& of) {
    std::uint32_t found = 0;
    for (std::uint32_t power = of.power; power > 1; power /= of.base, number /= of.base)
      found = found * of.base + number % of.base;
    return found;
  }

  std::array<Known, kDimensions> known_{};
};

/// By the last point in doubles, for one index after the other (Struckmeier 1995; Keller). Drifts.
class KellerHalton : public OneByOne {
 public:
  double next() {
    const std::size_t dimension = dimension_++;
    const double step = 1.0 / HaltonSequence::bases()[dimension].base;
    double& x = known_[dimension];
    if (index_ == 0) return x = 0;
    const double rest = 1 - x - 1e-10;
    if (step < rest) return x += step;
    double last = step, h = step * step;
    while (h >= rest) last = h, h *= step;
    return x += last + h - 1;
  }

 private:
  std::array<double, kDimensions> known_{};
};

/// Equation 9 as it is printed: all 63 terms.
class PlainSobol : public OneByOne {
 public:
  double next() {
    const auto& of = SobolSequence::directions()[dimension_++];
    std::uint64_t digits = 0;
    for (std::size_t digit = 0; digit < 63; ++digit) digits ^= (index_ >> digit & 1) * of[digit];
    return SobolSequence::value(digits);
  }
};

/// Equation 9 up to the index's highest digit.
class ShortSobol : public OneByOne {
 public:
  double next() {
    const auto& of = SobolSequence::directions()[dimension_++];
    std::uint64_t digits = 0;
    for (std::uint64_t rest = index_; rest != 0; rest &= rest - 1)
      digits ^= of[static_cast<std::size_t>(std::countr_zero(rest))];
    return SobolSequence::value(digits);
  }
};

/// In the order of Gray's code, for one point after the other (Antonov & Saleev 1979).
class GraySobol : public OneByOne {
 public:
  double next() {
    const std::size_t dimension = dimension_++;
    std::uint64_t& digits = known_[dimension];
    if (index_ != 0) digits ^= directions_[dimension][static_cast<std::size_t>(std::countr_zero(index_))];
    return SobolSequence::value(digits);
  }

 private:
  const SobolSequence::Directions& directions_ = SobolSequence::directions();
  std::array<std::uint64_t, kDimensions> known_{};
};

/// The C++ library's usual generator, whose numbers depend on those before.
class MersenneTwister : public OneByOne {
 public:
  double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace fluxel::bench

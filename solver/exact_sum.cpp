#include "solver/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace fluxel {

namespace {

static_assert(std::numeric_limits<double>::is_iec559);

constexpr int kMantissaBits = 52, kDigitBits = 32;
constexpr std::uint64_t kExponentMask = 0x7ff, kDigitMask = 0xffffffff;

/// Of the lowest digit, as the smallest double has it.
constexpr int kLowestExponent = -1074;

constexpr std::size_t kDigits = ExactSum::kWords - 1;

}  // namespace

void ExactSum::add(double term) {
  const auto bits = std::bit_cast<std::uint64_t>(term);
  const std::uint64_t exponent = bits >> kMantissaBits & kExponentMask;
  if (exponent == kExponentMask) {
    ++words_.back();
    return;
  }
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << kMantissaBits) - 1);
  const std::uint64_t mantissa = exponent > 0 ? fraction | std::uint64_t{1} << kMantissaBits : fraction;
  // Numbers below the smallest normal one have the exponent of that.
  const std::uint64_t place = exponent > 0 ? exponent - 1 : 0;
  const std::uint64_t shift = place % kDigitBits;
  const std::uint64_t low = (mantissa & kDigitMask) << shift, high = (mantissa >> kDigitBits) << shift;
  // All bits set turns a digit into its negative, less 1.
  const std::uint64_t sign = std::uint64_t{0} - (bits >> 63);
  const auto with_sign = [sign](std::uint64_t digit) { return (digit ^ sign) - sign; };
  std::uint64_t* const digits = &words_[place / kDigitBits];
  digits[0] += with_sign(low & kDigitMask);
  digits[1] += with_sign((low >> kDigitBits) + (high & kDigitMask));
  digits[2] += with_sign(high >> kDigitBits);
}

double ExactSum::value() const {
  if (words_.back() > 0) return std::numeric_limits<double>::quiet_NaN();
  // Of the magnitude, so that the highest digits do not cancel.
  std::array<std::uint64_t, kDigits> digits{};
  const auto carry_all = [&](std::uint64_t sign) {
    std::int64_t carry = 0;
    for (std::size_t k = 0; k < kDigits; ++k) {
      const std::int64_t digit = static_cast<std::int64_t>((words_[k] ^ sign) - sign) + carry;
      digits[k] = static_cast<std::uint64_t>(digit) & kDigitMask;
      carry = digit >> kDigitBits;
    }
    return carry;
  };
  const bool negative = carry_all(0) < 0;
  if (negative) carry_all(~std::uint64_t{0});
  std::size_t top = kDigits;
  while (top > 0 && digits[top - 1] == 0) --top;
  if (top == 0) return 0;
  const auto from_top = [&](std::size_t k) { return k < top ? digits[top - 1 - k] : 0; };
  // The 64 highest bits, of which the lowest is set where any below is: rounded once, and alike wherever the
  // digits end.
  const int zeros = std::countl_zero(static_cast<std::uint32_t>(digits[top - 1]));
  const std::uint64_t third = from_top(2) << zeros;
  std::uint64_t head = ((from_top(0) << kDigitBits | from_top(1)) << zeros) | third >> kDigitBits;
  bool is_more = (third & kDigitMask) != 0;
  for (std::size_t k = 3; k < top; ++k) is_more = is_more || from_top(k) != 0;
  if (is_more) head |= 1;
  const double sum = std::ldexp(static_cast<double>(head),
                                kLowestExponent + (static_cast<int>(top) - 2) * kDigitBits - zeros);
  return negative ? -sum : sum;
}

}  // namespace fluxel

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fluxel {

/// The first primes, ascending.
template <std::size_t Count>
[[nodiscard]] constexpr std::array<std::uint32_t, Count> first_primes() {
  std::array<std::uint32_t, Count> primes{};
  std::size_t found = 0;
  for (std::uint32_t number = 2; found < Count; ++number) {
    bool is_prime = true;
    for (std::size_t k = 0; k < found && is_prime; ++k) is_prime = number % primes[k] != 0;
    if (is_prime) primes[found++] = number;
  }
  return primes;
}

}  // namespace fluxel

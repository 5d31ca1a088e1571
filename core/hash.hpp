#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fluxel {

/// XXH3 of the bytes (Collet, xxHash), 64 bits.
[[nodiscard]] std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed = 0);

/// 16 hexadecimal digits.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

}  // namespace fluxel

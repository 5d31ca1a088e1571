#include "output/html/base64.hpp"

#include <array>
#include <cstdint>

namespace fluxel {

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b)
      bits = bits << 8U | (b < count ? static_cast<std::uint8_t>(bytes[k + b]) : 0U);
    for (std::size_t letter = 0; letter < 4; ++letter)
      text += letter <= count ? kLetters[bits >> (18 - 6 * letter) & 63U] : '=';
  }
  return text;
}

}  // namespace fluxel

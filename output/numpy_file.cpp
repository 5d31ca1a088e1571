#include "output/numpy_file.hpp"

#include <fmt/format.h>

#include <bit>

namespace fluxel {

std::string numpy_header(std::string_view descr, const std::vector<std::uint64_t>& shape) {
  static_assert(std::endian::native == std::endian::little, "numbers that follow are little endian");
  constexpr std::size_t kAligned = 64;
  std::string lengths;
  for (const std::uint64_t length : shape) lengths += fmt::format("{},", length);
  std::string text = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': ({}), }}", descr, lengths);
  std::string bytes("\x93NUMPY\x01\x00", 8);
  const std::size_t before = bytes.size() + 2;
  text.resize((before + text.size() + 1 + kAligned - 1) / kAligned * kAligned - before - 1, ' ');
  text += '\n';
  bytes += static_cast<char>(text.size() & 0xFFu);
  bytes += static_cast<char>(text.size() >> 8);
  return bytes + text;
}

}  // namespace fluxel

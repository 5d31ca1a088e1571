#include "scene/readers/ply_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/input_error_at.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

template <class Value>
double decode(std::string_view raw, bool reversed) {
  std::array<char, sizeof(Value)> bytes{};
  std::memcpy(bytes.data(), raw.data(), sizeof(Value));
  if (reversed) std::ranges::reverse(bytes);
  return static_cast<double>(std::bit_cast<Value>(bytes));
}

double decode(std::string_view raw, PlyType type, bool reversed) {
  switch (type) {
    case PlyType::int8:
      return decode<std::int8_t>(raw, reversed);
    case PlyType::uint8:
      return decode<std::uint8_t>(raw, reversed);
    case PlyType::int16:
      return decode<std::int16_t>(raw, reversed);
    case PlyType::uint16:
      return decode<std::uint16_t>(raw, reversed);
    case PlyType::int32:
      return decode<std::int32_t>(raw, reversed);
    case PlyType::uint32:
      return decode<std::uint32_t>(raw, reversed);
    case PlyType::float32:
      return decode<float>(raw, reversed);
    case PlyType::float64:
      break;
  }
  return decode<double>(raw, reversed);
}

}  // namespace

PlyValues::PlyValues(const std::filesystem::path& file, const std::string& bytes, const PlyHeader& header)
    : file_(file),
      bytes_(bytes),
      encoding_(header.encoding),
      place_(header.body),
      words_(file, std::string_view(bytes).substr(header.body), header.body_line) {
  if (encoding_ != PlyEncoding::ascii) return;
  require_text(file, bytes);
  words_.next();
}

void PlyValues::begin_item() {
  if (encoding_ != PlyEncoding::ascii) return;
  if (words_.word().empty()) throw words_.error("the file ends before its last item");
  if (words_.line() == item_line_) {
    throw words_.error(fmt::format("{} is one number too many", in_quotes(words_.word())),
                       "each item of an element stands on a line of its own");
  }
  item_line_ = words_.line();
}

double PlyValues::next(PlyType type, const char* subject) {
  if (encoding_ == PlyEncoding::ascii) return next_in_text(type, subject);
  last_place_ = place_;
  const std::size_t size = bytes_of(type);
  if (bytes_.size() - place_ < size) throw error(fmt::format("{}: the file ends here", subject));
  place_ += size;
  constexpr PlyEncoding kNative =
      std::endian::native == std::endian::little ? PlyEncoding::little_endian : PlyEncoding::big_endian;
  return decode(bytes_.substr(last_place_, size), type, encoding_ != kNative);
}

double PlyValues::next_in_text(PlyType type, const char* subject) {
  if (words_.word().empty() || words_.line() != item_line_)
    throw input_error_at(file_, item_line_, fmt::format("{}: the line has too few numbers", subject));
  const double value = words_.number(subject);
  if (is_whole(type) && value != std::floor(value))
    throw words_.error(fmt::format("{}: {} is not a whole number", subject, in_quotes(words_.word())));
  words_.next();
  return value;
}

InputError PlyValues::error(const std::string& what, const std::string& hint) const {
  if (encoding_ == PlyEncoding::ascii) return input_error_at(file_, item_line_, what, hint);
  return input_error_at(file_, 0, fmt::format("byte {}: {}", last_place_, what), hint);
}

}  // namespace fluxel

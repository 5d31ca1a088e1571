#include "scene/readers/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <unordered_set>
#include <utility>

#include "core/input_error_at.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

struct NamedPlyType {
  std::string_view name, other_name;
  PlyType type;
  std::size_t bytes;
};

/// In the order of PlyType.
constexpr std::array kPlyTypes{
    NamedPlyType{"char", "int8", PlyType::int8, 1},
    NamedPlyType{"uchar", "uint8", PlyType::uint8, 1},
    NamedPlyType{"short", "int16", PlyType::int16, 2},
    NamedPlyType{"ushort", "uint16", PlyType::uint16, 2},
    NamedPlyType{"int", "int32", PlyType::int32, 4},
    NamedPlyType{"uint", "uint32", PlyType::uint32, 4},
    NamedPlyType{"float", "float32", PlyType::float32, 4},
    NamedPlyType{"double", "float64", PlyType::float64, 8},
};

/// Reads a header line by line.
class PlyHeaderParser {
 public:
  PlyHeaderParser(const std::filesystem::path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  PlyHeader run() {
    next_line();
    if (rest_ != "ply") throw error("this is no PLY file", "it must begin with a line 'ply'");
    while (true) {
      next_line();
      const std::string_view keyword = next_word(rest_);
      if (keyword == "format") {
        read_format();
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property();
      } else if (keyword == "end_header") {
        break;
      } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
        throw error(fmt::format("unknown keyword {} in the header", in_quotes(keyword)));
      }
    }
    if (!has_format_) throw error("the header says no format", "format ascii 1.0");
    header_.body = place_;
    header_.body_line = line_ + 1;
    check_items();
    return std::move(header_);
  }

 private:
  void next_line() {
    ++line_;
    if (place_ == bytes_.size()) throw error("the header ends too early", "it needs a line 'end_header'");
    const std::size_t end = std::min(bytes_.find_first_of("\n\r", place_), bytes_.size());
    rest_ = trim(bytes_.substr(place_, end - place_));
    place_ = std::min(end + (bytes_.substr(end, 2) == "\r\n" ? 2 : 1), bytes_.size());
    const bool binary =
        std::ranges::any_of(rest_, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t'; });
    if (binary) throw error("the header holds binary data");
  }

  void read_format() {
    const std::string_view name = next_word(rest_);
    if (name == "ascii") {
      header_.encoding = PlyEncoding::ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = PlyEncoding::little_endian;
    } else if (name == "binary_big_endian") {
      header_.encoding = PlyEncoding::big_endian;
    } else {
      throw error(fmt::format("unknown format {}", in_quotes(name)),
                  "known: ascii, binary_little_endian, binary_big_endian");
    }
    if (const std::string_view version = next_word(rest_); version != "1.0")
      throw error(fmt::format("unknown version {} of the format", in_quotes(version)), "known: 1.0");
    has_format_ = true;
  }

  void read_element() {
    PlyElement element;
    element.name = next_word(rest_);
    const std::string_view items = next_word(rest_);
    const auto [stop, status] = std::from_chars(items.data(), items.data() + items.size(), element.items);
    if (status != std::errc{} || stop != items.data() + items.size()) {
      throw error(fmt::format("the number {} of items of element {} is not a whole number", in_quotes(items),
                              in_quotes(element.name)));
    }
    if (!names_.insert(element.name).second)
      throw error(fmt::format("element {} stands twice", in_quotes(element.name)));
    header_.elements.push_back(std::move(element));
    lines_.push_back(line_);
  }

  void read_property() {
    if (header_.elements.empty()) throw error("a property stands before any element");
    PlyProperty property;
    std::string_view type = next_word(rest_);
    if (type == "list") {
      property.list_count = read_type(next_word(rest_));
      if (!is_whole(*property.list_count)) throw error("the length of a list must be a whole number");
      type = next_word(rest_);
    }
    property.type = read_type(type);
    property.name = next_word(rest_);
    if (property.name.empty()) throw error("a property has no name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  [[nodiscard]] PlyType read_type(std::string_view name) const {
    const auto found = std::ranges::find_if(
        kPlyTypes, [&](const NamedPlyType& type) { return type.name == name || type.other_name == name; });
    if (found == kPlyTypes.end()) throw error(fmt::format("unknown type {}", in_quotes(name)));
    return found->type;
  }

  /// A number takes its bytes; of a text a digit and a blank, the last one no blank.
  void check_items() const {
    const bool text = header_.encoding == PlyEncoding::ascii;
    const std::uint64_t total = bytes_.size() - header_.body;
    std::uint64_t left = total + (text ? 1 : 0);
    for (std::size_t i = 0; i < header_.elements.size(); ++i) {
      const PlyElement& element = header_.elements[i];
      std::uint64_t least = 0;
      for (const PlyProperty& property : element.properties)
        least += text ? 2 : bytes_of(property.list_count.value_or(property.type));
      if (least == 0) continue;
      if (element.items > left / least) {
        throw input_error_at(
            file_, lines_[i],
            fmt::format("the file is too short for {} items of element {}", element.items,
                        in_quotes(element.name)),
            fmt::format("{} bytes follow the header, an item takes {} at least", total, least));
      }
      left -= element.items * least;
    }
  }

  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const {
    return input_error_at(file_, line_, what, hint);
  }

  const std::filesystem::path& file_;
  std::string_view bytes_;
  PlyHeader header_;
  std::string_view rest_;  // of the line
  std::size_t place_ = 0;
  std::size_t line_ = 0;
  bool has_format_ = false;
  std::vector<std::size_t> lines_;  // of the elements
  std::unordered_set<std::string> names_;
};

}  // namespace

std::size_t bytes_of(PlyType type) { return kPlyTypes[static_cast<std::size_t>(type)].bytes; }

bool is_whole(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  const auto found = std::ranges::find(properties, property, &PlyProperty::name);
  if (found == properties.end()) return std::nullopt;
  return static_cast<std::size_t>(found - properties.begin());
}

PlyHeader read_ply_header(const std::filesystem::path& file, const std::string& bytes) {
  return PlyHeaderParser(file, bytes).run();
}

}  // namespace fluxel

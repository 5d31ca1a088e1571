#include "scene/readers/texture_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

namespace fluxel {
namespace {

/// An option of a map, and how many values follow it at least and at most; those beyond the least are
/// numbers.
struct MapOption {
  std::string_view name;
  int least, most;
};

constexpr std::array kMapOptions{
    MapOption{"-blendu", 1, 1},  MapOption{"-blendv", 1, 1}, MapOption{"-boost", 1, 1},
    MapOption{"-bm", 1, 1},      MapOption{"-cc", 1, 1},     MapOption{"-clamp", 1, 1},
    MapOption{"-imfchan", 1, 1}, MapOption{"-mm", 2, 2},     MapOption{"-o", 1, 3},
    MapOption{"-s", 1, 3},       MapOption{"-t", 1, 3},      MapOption{"-texres", 1, 1},
    MapOption{"-type", 1, 1}};

bool is_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [stop, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  return !word.empty() && status == std::errc{} && stop == word.data() + word.size();
}

/// The last word is the image's name, or the end of it, and never a value.
std::vector<std::string_view> take_values(const MapOption& option, std::string_view& rest) {
  std::vector<std::string_view> values;
  for (int k = 0; k < option.most; ++k) {
    std::string_view after = rest;
    const std::string_view word = next_word(after);
    if (trim(after).empty() || (k >= option.least && !is_number(word))) break;
    values.push_back(word);
    rest = after;
  }
  return values;
}

/// Of u and v; a w has no part in an image of two dimensions.
void read_vector(const Statements& at, const std::vector<std::string_view>& values, const char* subject,
                 glm::dvec2& vector) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double value = parse_number(at, values[k], subject);
    if (k < 2) vector[static_cast<glm::length_t>(k)] = value;
  }
}

}  // namespace

TextureMap parse_texture_map(const Statements& at, std::string_view keyword, std::string_view rest,
                             const std::filesystem::path& folder, KeyCounts& unused) {
  TextureMap map;
  for (rest = trim(rest); rest.starts_with('-'); rest = trim(rest)) {
    std::string_view after = rest;
    const std::string_view name = next_word(after);
    const auto* const option = std::ranges::find(kMapOptions, name, &MapOption::name);
    if (option == kMapOptions.end()) break;  // a name that begins with -
    const std::vector<std::string_view> values = take_values(*option, after);
    if (static_cast<int>(values.size()) < option->least)
      throw at.error(fmt::format("{} {}: too few values before the image's name", keyword, name));
    rest = after;
    if (name == "-s") {
      read_vector(at, values, "scale -s of a map", map.scale);
    } else if (name == "-o") {
      read_vector(at, values, "offset -o of a map", map.offset);
    } else {
      unused.add(fmt::format("{} {}", keyword, name));
    }
  }
  if (rest.empty()) throw at.error(fmt::format("{} names no image", keyword));
  std::string name(rest);
  std::ranges::replace(name, '\\', '/');
  map.image = folder / name;
  map.beside = folder / map.image.filename();
  return map;
}

}  // namespace fluxel

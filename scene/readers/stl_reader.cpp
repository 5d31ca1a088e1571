#include "scene/readers/stl_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "core/input_error_at.hpp"
#include "scene/readers/default_material.hpp"
#include "scene/readers/format_limits.hpp"
#include "scene/readers/statements.hpp"
#include "scene/readers/words.hpp"

namespace fluxel {
namespace {

constexpr std::size_t kStlHeaderBytes = 80, kCountBytes = 4, kFacetBytes = 50;
constexpr std::size_t kNumbersOfAFacet = 12;  // the normal and three corners

struct Facet {
  glm::dvec3 normal;  ///< as stored; 0 or not finite where a program does not care
  std::array<glm::dvec3, 3> corners;
};

/// What both forms of the format fill.
struct StlScene {
  explicit StlScene(const std::filesystem::path& file) : stem(file.stem().string()) {
    input.name = stem;
    input.file = file;
    input.geometry.push_back({.file = file});
    input.materials.emplace_back().name = kDefaultMaterial;
  }

  void use_group(std::string_view name) {
    const std::string group(name.empty() ? std::string_view(stem) : name);
    const auto [entry, added] = groups.try_emplace(group, GroupId{static_cast<std::uint32_t>(groups.size())});
    if (added) input.groups.push_back(group);
    current = entry->second;
  }

  void add(const Facet& facet) {
    const auto& [a, b, c] = facet.corners;
    if (glm::dot(facet.normal, glm::cross(b - a, c - a)) < 0) ++turned;
    input.polygons.push_back({{a, b, c}, MaterialId{0}, current});
  }

  /// The scene, where there is one.
  SceneInput finish() {
    const std::string file = input.file.string();
    if (input.polygons.empty()) throw input_error_at(input.file, 0, "holds no facet");
    input.notes.push_back(
        fmt::format("{}: STL has no materials: all {} facets have one, '{}' unless [[geometry]] names it, of "
                    "reflectance {} "
                    "unless [materials] sets it",
                    file, input.polygons.size(), kDefaultMaterial, input.materials[0].rho.r));
    if (turned > 0) {
      input.notes.push_back(fmt::format(
          "{}: the stored normals of {} of {} facets contradict the order of their corners, which counts",
          file, turned, input.polygons.size()));
    }
    if (with_attribute > 0) {
      input.notes.push_back(fmt::format("{}: attributes (colours) of {} of {} facets are ignored", file,
                                        with_attribute, input.polygons.size()));
    }
    return std::move(input);
  }

  SceneInput input;
  std::string stem;
  std::unordered_map<std::string, GroupId> groups;
  GroupId current{};
  std::size_t turned = 0;          ///< facets whose stored normal points to the back
  std::size_t with_attribute = 0;  ///< facets of attribute bytes other than 0
};

bool is_word(std::string_view word, std::string_view lower) {
  return std::ranges::equal(word, lower,
                            [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

/// The facets of a text.
class StlText {
 public:
  StlText(const std::filesystem::path& file, const std::string& text, StlScene& scene)
      : words_(file, text), scene_(scene) {
    require_text(file, text);
  }

  void read() {
    while (words_.next()) {
      if (!is_word(words_.word(), "solid")) throw unexpected("solid");
      scene_.use_group(words_.rest_of_line());
      read_solid();
    }
  }

 private:
  void read_solid() {
    while (words_.next() && is_word(words_.word(), "facet")) read_facet();
    if (!is_word(words_.word(), "endsolid")) throw unexpected("facet' or 'endsolid");
    words_.rest_of_line();  // the name again
  }

  void read_facet() {
    Facet facet{};
    expect("normal");
    for (int axis = 0; axis < 3; ++axis) facet.normal[axis] = normal_component();
    expect("outer");
    expect("loop");
    for (glm::dvec3& corner : facet.corners) {
      expect("vertex");
      for (int axis = 0; axis < 3; ++axis) corner[axis] = coordinate();
    }
    expect("endloop");
    expect("endfacet");
    scene_.add(facet);
  }

  void expect(const char* keyword) {
    words_.next();
    if (!is_word(words_.word(), keyword)) throw unexpected(keyword);
  }

  [[nodiscard]] InputError unexpected(const char* expected) const {
    if (words_.word().empty())
      return words_.error(fmt::format("the file ends where '{}' must stand", expected), "was it cut off?");
    return words_.error(fmt::format("'{}' must stand here, not {}", expected, in_quotes(words_.word())));
  }

  /// A normal that is no number is one that the program which wrote the file could not tell.
  double normal_component() {
    words_.next();
    std::string_view word = words_.word();
    if (!word.empty() && word.front() == '-') word.remove_prefix(1);
    if (is_word(word.substr(0, 3), "nan") || is_word(word.substr(0, 3), "inf")) return 0;
    return words_.number("facet normal");
  }

  double coordinate() {
    words_.next();
    const double value = words_.number("vertex coordinate");
    if (std::abs(value) > kMaxCoordinate)
      throw words_.error(fmt::format("vertex coordinate {} is too large", in_quotes(words_.word())),
                         fmt::format("at most {}", kMaxCoordinate));
    return value;
  }

  Words words_;
  StlScene& scene_;
};

template <class Value>
Value little_endian_at(const std::string& bytes, std::size_t place) {
  std::array<char, sizeof(Value)> raw{};
  std::memcpy(raw.data(), bytes.data() + place, sizeof(Value));
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(raw);
  return std::bit_cast<Value>(raw);
}

/// Binary files may begin with `solid` as well. But they hold zeros, in their count if nowhere else, and
/// texts hold none.
bool is_stl_text(const std::string& bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // or a byte order mark
  const bool begins =
      start != std::string::npos && is_word(std::string_view(bytes).substr(start, 5), "solid");
  return begins && bytes.find('\0') == std::string::npos;
}

/// The name that a binary file's header gives: up to the first byte that is not printed.
std::string_view header_name(const std::string& bytes) {
  std::string_view header = std::string_view(bytes).substr(0, kStlHeaderBytes);
  const auto end = std::ranges::find_if(header, [](char c) { return c < 0x20 || c > 0x7e; });
  header = header.substr(0, static_cast<std::size_t>(end - header.begin()));
  std::string_view rest = header;
  if (is_word(next_word(rest), "solid")) header = rest;
  return trim(header);
}

void read_binary(const std::filesystem::path& file, const std::string& bytes, StlScene& scene) {
  constexpr std::size_t kStart = kStlHeaderBytes + kCountBytes;
  if (bytes.size() < kStart) {
    throw input_error_at(
        file, 0, "this is no STL file",
        fmt::format("a text begins with 'solid'; a binary file has {} bytes at least", kStart));
  }
  const std::uint64_t facets = little_endian_at<std::uint32_t>(bytes, kStlHeaderBytes);
  const std::uint64_t promised = kStart + facets * kFacetBytes;
  if (promised != bytes.size()) {
    throw input_error_at(file, 0,
                         fmt::format("byte {}: {} triangles need a file of {} bytes, this one has {}",
                                     kStlHeaderBytes, facets, promised, bytes.size()),
                         "it was cut off, or is no STL file");
  }
  scene.use_group(header_name(bytes));
  scene.input.polygons.reserve(facets);
  for (std::size_t start = kStart; start < bytes.size(); start += kFacetBytes) {
    std::array<double, kNumbersOfAFacet> numbers{};
    for (std::size_t k = 0; k < kNumbersOfAFacet; ++k) {
      const std::size_t place = start + k * sizeof(float);
      numbers[k] = little_endian_at<float>(bytes, place);
      const bool of_normal = k < 3;
      if (!of_normal && !(std::abs(numbers[k]) <= kMaxCoordinate)) {
        throw input_error_at(
            file, 0,
            fmt::format("byte {}: vertex coordinate {} is not finite or too large", place, numbers[k]),
            fmt::format("at most {}", kMaxCoordinate));
      }
    }
    const auto vector = [&](std::size_t k) { return glm::dvec3(numbers[k], numbers[k + 1], numbers[k + 2]); };
    scene.add({vector(0), {vector(3), vector(6), vector(9)}});
    if (little_endian_at<std::uint16_t>(bytes, start + kNumbersOfAFacet * sizeof(float)) != 0)
      ++scene.with_attribute;
  }
}

}  // namespace

SceneInput read_stl(const std::filesystem::path& file, const std::string& bytes, const TextLookup&) {
  StlScene scene(file);
  if (is_stl_text(bytes)) {
    StlText(file, bytes, scene).read();
  } else {
    read_binary(file, bytes, scene);
  }
  return scene.finish();
}

}  // namespace fluxel

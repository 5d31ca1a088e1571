#include "scene/readers/primitive_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/readers/default_material.hpp"
#include "scene/readers/format_limits.hpp"

namespace fluxel {
namespace {

constexpr std::array<std::string_view, 6> kSides{"-x", "+x", "-y", "+y", "-z", "+z"};

/// Positive lengths [m].
template <std::size_t kCount>
std::array<double, kCount> read_lengths(const TomlFile& toml, const toml::node& node, const char* key) {
  const toml::array& values = toml.array(node, key, kCount);
  std::array<double, kCount> lengths{};
  for (std::size_t i = 0; i < kCount; ++i) {
    lengths[i] = toml.number(values[i], key);
    if (!(lengths[i] > 0 && lengths[i] <= kMaxCoordinate))
      throw toml.error(values[i].source(), fmt::format("{} has a side of {}", key, lengths[i]),
                       "greater than 0; mirror and translate bring it elsewhere");
  }
  return lengths;
}

/// The corners of a box's side, counter-clockwise as seen from outside.
std::vector<glm::dvec3> side_of_box(std::size_t side, const std::array<double, 3>& lengths) {
  const auto across = static_cast<int>(side / 2);
  const bool upper = side % 2 == 1;
  const int u = (across + 1) % 3, v = (across + 2) % 3;  // u x v points along the axis
  std::vector<glm::dvec3> corners;
  for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    glm::dvec3 corner(0);
    corner[across] = upper ? lengths[static_cast<std::size_t>(across)] : 0;
    corner[u] = a * lengths[static_cast<std::size_t>(u)];
    corner[v] = b * lengths[static_cast<std::size_t>(v)];
    corners.push_back(corner);
  }
  if (!upper) std::ranges::reverse(corners);
  return corners;
}

/// Adds polygons with the materials that a table names.
class Primitive {
 public:
  Primitive(const TomlFile& toml, const toml::table& table, const char* shape) : toml_(toml), group_(shape) {
    part.file = toml.path;
    if (const toml::node* const name = table.get("group")) group_ = text(*name, "group");
    if (const toml::node* const name = table.get("material")) material_ = text(*name, "material");
    if (const toml::node* const sides = table.get("material_of")) {
      of_sides_ = &toml.table(*sides, "material_of");
      toml.require_known_keys(*of_sides_, "material_of", {"-x", "+x", "-y", "+y", "-z", "+z"});
    }
  }

  /// A side of a box by its name, or with an empty one the whole shape.
  void add(std::string_view side, std::vector<glm::dvec3> corners) {
    const toml::node* const own = of_sides_ == nullptr ? nullptr : of_sides_->get(side);
    const std::string material = own == nullptr ? material_ : text(*own, "material_of");
    auto found = std::ranges::find(part.materials, material, &InputMaterial::name);
    if (found == part.materials.end()) {
      InputMaterial& added = part.materials.emplace_back();
      added.name = material;
      added.is_named_alone = true;
      found = part.materials.end() - 1;
    }
    const auto id = static_cast<std::uint32_t>(found - part.materials.begin());
    const auto group = static_cast<std::uint32_t>(part.groups.size());
    part.groups.push_back(side.empty() ? group_ : fmt::format("{} {}", group_, side));
    part.polygons.push_back({std::move(corners), MaterialId{id}, GroupId{group}});
  }

  SceneInput part;

 private:
  [[nodiscard]] std::string text(const toml::node& node, const char* key) const {
    std::string value = toml_.text(node, key);
    if (value.empty()) throw toml_.error(node.source(), fmt::format("{} is empty", key), "give a name");
    if (std::ranges::any_of(value, [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
      throw toml_.error(node.source(), fmt::format("{} has a control character", key),
                        "give a name of one line");
    return value;
  }

  const TomlFile& toml_;
  std::string group_, material_ = kDefaultMaterial;
  const toml::table* of_sides_ = nullptr;
};

SceneInput read_box(const TomlFile& toml, const toml::table& table) {
  const std::array<double, 3> lengths = read_lengths<3>(toml, *table.get("box"), "box");
  bool inwards = false;
  if (const toml::node* const value = table.get("inwards")) {
    if (!value->is_boolean()) throw toml.error(value->source(), "inwards must be true or false");
    inwards = value->as_boolean()->get();
  }
  Primitive box(toml, table, "box");
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    std::vector<glm::dvec3> corners = side_of_box(side, lengths);
    if (inwards) std::ranges::reverse(corners);
    box.add(kSides[side], std::move(corners));
  }
  return std::move(box.part);
}

SceneInput read_rectangle(const TomlFile& toml, const toml::table& table) {
  const auto [a, b] = read_lengths<2>(toml, *table.get("rectangle"), "rectangle");
  for (const char* const key : {"inwards", "material_of"})
    if (const toml::node* const value = table.get(key))
      throw toml.error(value->source(), fmt::format("{} is of a box alone", key));
  Primitive rectangle(toml, table, "rectangle");
  rectangle.add("", {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}});
  return std::move(rectangle.part);
}

}  // namespace

bool names_primitive(const toml::table& table) {
  return table.contains("box") || table.contains("rectangle");
}

SceneInput read_primitive(const TomlFile& toml, const toml::table& table) {
  const bool box = table.contains("box");
  for (const char* const other : {"file", "rectangle"}) {
    const toml::node* const value = table.get(other);
    if (value != nullptr && (box || std::string_view(other) == "file"))
      throw toml.error(value->source(), "[[geometry]] has two shapes",
                       "one of file, box and rectangle; write another [[geometry]] for each");
  }
  return box ? read_box(toml, table) : read_rectangle(toml, table);
}

}  // namespace fluxel

#pragma once

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "core/input_error_at.hpp"
#include "core/material.hpp"
#include "scene/list_names.hpp"

namespace fluxel {

using Keys = std::initializer_list<std::string_view>;

/// The unit vector normal to `axis` that is nearest to `towards`, both of them unit vectors; none where they
/// are parallel.
[[nodiscard]] inline std::optional<glm::dvec3> beside(const glm::dvec3& axis, const glm::dvec3& towards) {
  const glm::dvec3 normal = towards - glm::dot(towards, axis) * axis;
  if (!(glm::length(normal) > 1e-6)) return std::nullopt;
  const glm::dvec3 once = glm::normalize(normal);
  return glm::normalize(once - glm::dot(once, axis) * axis);  // what rounding left
}

/// Reads single values of a TOML file and says where they are wrong.
struct TomlFile {
  const std::filesystem::path& path;

  [[nodiscard]] InputError error(const toml::source_region& place, const std::string& what,
                                 const std::string& hint = {}) const {
    return input_error_at(path, place.begin.line, what, hint);
  }

  void require_known_keys(const toml::table& table, const std::string& where, Keys known) const {
    for (const auto& [key, value] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      throw error(key.source(), fmt::format("unknown key '{}' in {}", key.str(), where),
                  known_names(key.str(), {known.begin(), known.end()}));
    }
  }

  [[nodiscard]] const toml::table& table(const toml::node& node, const std::string& name) const {
    if (!node.is_table()) throw error(node.source(), fmt::format("{} must be a table", name));
    return *node.as_table();
  }

  [[nodiscard]] std::string text(const toml::node& node, const std::string& name) const {
    if (!node.is_string()) throw error(node.source(), fmt::format("{} must be a text in quotes", name));
    return node.as_string()->get();
  }

  [[nodiscard]] double number(const toml::node& node, const std::string& name) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) throw error(node.source(), fmt::format("{} must be a number", name));
    if (!std::isfinite(*value)) throw error(node.source(), fmt::format("{} must be finite", name));
    return *value;
  }

  [[nodiscard]] const toml::array& array(const toml::node& node, const std::string& name,
                                         std::size_t size) const {
    if (!node.is_array() || node.as_array()->size() != size) {
      throw error(node.source(), fmt::format("{} must be an array of {} numbers", name, size));
    }
    return *node.as_array();
  }

  [[nodiscard]] glm::dvec3 vector(const toml::node& node, const std::string& name) const {
    const toml::array& values = array(node, name, 3);
    return {number(values[0], name), number(values[1], name), number(values[2], name)};
  }

  /// A place [m], no farther from the origin along any axis than 1e15 m.
  [[nodiscard]] glm::dvec3 point(const toml::node& node, const std::string& name) const {
    const glm::dvec3 value = vector(node, name);
    if (!(std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)}) <= 1e15))
      throw error(node.source(), fmt::format("{} is too far away", name));
    return value;
  }

  /// A unit vector.
  [[nodiscard]] glm::dvec3 direction(const toml::node& node, const std::string& name) const {
    const glm::dvec3 value = vector(node, name);
    const double largest = std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)});
    if (largest == 0) throw error(node.source(), fmt::format("{} has no direction", name));
    return glm::normalize(value / largest);
  }

  /// The direction at right angles to `axis` that is nearest to the one given.
  [[nodiscard]] glm::dvec3 direction_beside(const glm::dvec3& axis, const toml::node& node,
                                            const std::string& name, const std::string& name_of_axis) const {
    const std::optional<glm::dvec3> found = beside(axis, direction(node, name));
    if (!found) throw error(node.source(), fmt::format("{} is parallel to {}", name, name_of_axis));
    return *found;
  }

  /// A table's value that must be there; `needs` says of what the table consists.
  [[nodiscard]] const toml::node& require(const toml::table& table, const char* key, const std::string& where,
                                          const std::string& needs) const {
    if (const toml::node* const found = table.get(key)) return *found;
    throw error(table.source(), fmt::format("{} lacks {}", where, key), needs);
  }

  /// One number stands for all channels.
  [[nodiscard]] Rgb colour(const toml::node& node, const std::string& name) const {
    return node.is_array() ? vector(node, name) : Rgb{number(node, name)};
  }

  [[nodiscard]] Sides sides(const toml::node& node, const std::string& name) const {
    const std::string value = text(node, name);
    if (value != "one" && value != "two") {
      throw error(node.source(), fmt::format("{} is '{}'", name, value), "one or two");
    }
    return value == "one" ? Sides::one : Sides::two;
  }
};

}  // namespace fluxel

#pragma once

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/material.hpp"
#include "scene/list_names.hpp"

namespace fluxel {

using Keys = std::initializer_list<std::string_view>;

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

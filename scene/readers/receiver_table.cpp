#include "scene/readers/receiver_table.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>
#include <utility>

namespace fluxel {

namespace {

/// Names are parts of files' names, of which file systems take up to 255 letters.
bool is_file_name(const std::string& name) {
  constexpr std::size_t kMostLetters = 128;
  return !name.empty() && name.size() <= kMostLetters && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
}

std::pair<int, int> read_cells(const TomlFile& toml, const toml::node& node, const std::string& name) {
  constexpr std::int64_t kMaxCells = 65536;  // a side, as of a picture
  const toml::array& values = toml.array(node, name, 2);
  std::array<int, 2> cells{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::int64_t value = values[i].is_integer() ? values[i].as_integer()->get() : 0;
    if (value < 1 || value > kMaxCells)
      throw toml.error(node.source(),
                       fmt::format("{} must be two whole numbers from 1 to {}", name, kMaxCells));
    cells[i] = static_cast<int>(value);
  }
  return {cells[0], cells[1]};
}

void read_receiver(const TomlFile& toml, const toml::node& node, SceneInput& scene) {
  const toml::table& table = toml.table(node, "[[receivers]]");
  toml.require_known_keys(table, "[[receivers]]", {"name", "origin", "u", "v", "cells"});
  const auto value = [&](const char* key) -> const toml::node& {
    const toml::node* const found = table.get(key);
    if (found == nullptr)
      throw toml.error(table.source(), fmt::format("[[receivers]] lacks {}", key),
                       "it needs name, origin, u, v and cells");
    return *found;
  };
  Receiver receiver;
  receiver.name = toml.text(value("name"), "receiver name");
  if (!is_file_name(receiver.name))
    throw toml.error(value("name").source(),
                     fmt::format("receiver name '{}' cannot be part of a file's name", receiver.name),
                     "up to 128 letters, digits, '-', '_' and '.'");
  if (std::ranges::any_of(scene.receivers, [&](const Receiver& of) { return of.name == receiver.name; }))
    throw toml.error(value("name").source(), fmt::format("a second receiver '{}'", receiver.name));
  receiver.origin = toml.vector(value("origin"), "receiver origin");
  receiver.u = toml.vector(value("u"), "receiver u");
  receiver.v = toml.vector(value("v"), "receiver v");
  const double sizes = glm::length(receiver.u) * glm::length(receiver.v);
  if (!(glm::length(glm::cross(receiver.u, receiver.v)) > 1e-9 * sizes) || !std::isfinite(sizes))
    throw toml.error(
        table.source(),
        fmt::format("receiver '{}' has no area: u and v are parallel, zero or too large", receiver.name));
  std::tie(receiver.columns, receiver.rows) = read_cells(toml, value("cells"), "receiver cells");
  scene.receivers.push_back(std::move(receiver));
}

}  // namespace

void read_receivers(const TomlFile& toml, const toml::node& node, SceneInput& scene) {
  if (!node.is_array()) throw toml.error(node.source(), "receivers must stand as [[receivers]]");
  for (const toml::node& receiver : *node.as_array()) read_receiver(toml, receiver, scene);
}

}  // namespace fluxel

#include "scene/readers/receiver_table.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/quantity_names.hpp"
#include "scene/readers/format_limits.hpp"
#include "scene/surface_grid.hpp"

namespace fluxel {

namespace {

/// Names are parts of files' names, of which file systems take up to 255 letters.
bool is_file_name(const std::string& name) {
  constexpr std::size_t kMostLetters = 128;
  return !name.empty() && name.size() <= kMostLetters && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
}

/// How a receiver may say where it is.
constexpr std::string_view kWheres =
    "origin, u, v and cells; surface, normal, and cells or spacing; points; or from, to and count";

/// Reads one table [[receivers]].
class ReceiverTable {
 public:
  ReceiverTable(const TomlFile& toml, const toml::table& table, const SceneInput& scene)
      : toml_(toml), table_(table), scene_(scene) {}

  [[nodiscard]] Receiver read() {
    toml_.require_known_keys(
        table_, "[[receivers]]",
        {"name", "quantity", "origin", "u", "v", "cells", "surface", "normal", "offset", "border", "spacing",
         "points", "from", "to", "count", "axis", "facing", "direction", "angle"});
    read_name();
    if (const toml::node* const node = table_.get("quantity")) read_quantity(*node);
    read_places();
    read_directions();
    return std::move(receiver_);
  }

 private:
  [[nodiscard]] const toml::node& require(const char* key, const std::string& needs) const {
    return toml_.require(table_, key, fmt::format("receiver '{}'", receiver_.name), needs);
  }

  [[nodiscard]] InputError wrong(const std::string& what, const std::string& hint = {}) const {
    return toml_.error(table_.source(), fmt::format("receiver '{}' {}", receiver_.name, what), hint);
  }

  /// Throws where a key stands that has no meaning beside the others.
  void refuse(const Keys& keys, const std::string& reason) const {
    for (const std::string_view key : keys)
      if (const toml::node* const found = table_.get(key))
        throw toml_.error(found->source(),
                          fmt::format("receiver '{}': {} has no meaning {}", receiver_.name, key, reason));
  }

  void read_name() {
    const toml::node& node = toml_.require(table_, "name", "[[receivers]]",
                                           "it needs name, and where it is: " + std::string(kWheres));
    receiver_.name = toml_.text(node, "receiver name");
    if (!is_file_name(receiver_.name))
      throw toml_.error(node.source(),
                        fmt::format("receiver name '{}' cannot be part of a file's name", receiver_.name),
                        "up to 128 letters, digits, '-', '_' and '.'");
    if (std::ranges::find(scene_.receivers, receiver_.name, &Receiver::name) != scene_.receivers.end())
      throw toml_.error(node.source(), fmt::format("a second receiver '{}'", receiver_.name));
  }

  void read_quantity(const toml::node& node) {
    const std::string name = toml_.text(node, "receiver quantity");
    const auto found = kQuantityNames.find(name);
    if (found == kQuantityNames.end()) {
      std::vector<std::string> known;
      known.reserve(kQuantityNames.size());
      for (const auto& [of, quantity] : kQuantityNames) known.push_back(of);
      throw toml_.error(node.source(), fmt::format("receiver quantity is '{}'", name),
                        known_names(name, known));
    }
    receiver_.quantity = found->second;
  }

  void read_places() {
    const bool corner = table_.contains("origin") || table_.contains("u") || table_.contains("v");
    const bool surface = table_.contains("surface"), points = table_.contains("points");
    const bool line = table_.contains("from") || table_.contains("to");
    if (int{corner} + int{surface} + int{points} + int{line} != 1)
      throw wrong("must say in one way where it is", std::string(kWheres));
    if (!surface) refuse({"offset", "border"}, "without a surface");
    if (!line) refuse({"count"}, "without a line");
    if (points || line) refuse({"cells", "spacing"}, "for single points");
    if (corner) read_grid();
    if (surface) read_surface();
    if (points) read_points();
    if (line) read_line();
  }

  void read_cells() {
    constexpr std::int64_t kMaxCells = 65536;  // a side, as of a picture
    const toml::node& node = require("cells", "the numbers of columns and rows, as [20, 10]");
    const toml::array& values = toml_.array(node, "receiver cells", 2);
    std::array<int, 2> cells{};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::int64_t value = values[i].is_integer() ? values[i].as_integer()->get() : 0;
      if (value < 1 || value > kMaxCells)
        throw toml_.error(node.source(),
                          fmt::format("receiver cells must be two whole numbers from 1 to {}", kMaxCells));
      cells[i] = static_cast<int>(value);
    }
    receiver_.columns = cells[0];
    receiver_.rows = cells[1];
    if (receiver_.size() > kMaxReceiverCells)
      throw toml_.error(node.source(), fmt::format("receiver '{}' has more than {} cells", receiver_.name,
                                                   kMaxReceiverCells));
  }

  void read_grid() {
    const std::string needs = "a grid needs origin, u, v and cells";
    refuse({"spacing"}, "without a surface");
    receiver_.origin = toml_.point(require("origin", needs), "receiver origin");
    receiver_.u = toml_.vector(require("u", needs), "receiver u");
    receiver_.v = toml_.vector(require("v", needs), "receiver v");
    const double sizes = glm::length(receiver_.u) * glm::length(receiver_.v);
    if (!(glm::length(glm::cross(receiver_.u, receiver_.v)) > 1e-9 * sizes) || !std::isfinite(sizes))
      throw wrong("has no area: u and v are parallel, zero or too large");
    read_cells();
  }

  [[nodiscard]] double within(const toml::node& node, const std::string& name) const {
    const double length = toml_.number(node, name);
    if (!(std::abs(length) <= kMaxCoordinate)) throw toml_.error(node.source(), name + " is too far");
    return length;
  }

  [[nodiscard]] double length_of(const toml::node& node, const std::string& name) const {
    const double length = within(node, name);
    if (!(length > 0)) throw toml_.error(node.source(), name + " must be greater than 0 m");
    return length;
  }

  /// The polygons of the group that is named.
  [[nodiscard]] std::vector<Polygon> polygons_of(const toml::node& node) const {
    const std::string name = toml_.text(node, "receiver surface");
    const auto group = std::ranges::find(scene_.groups, name);
    if (group == scene_.groups.end())
      throw toml_.error(node.source(), fmt::format("no geometry has a group '{}'", name),
                        known_names(name, scene_.groups));
    const GroupId wanted{static_cast<std::uint32_t>(group - scene_.groups.begin())};
    std::vector<Polygon> polygons;
    for (const InputPolygon& polygon : scene_.polygons)
      if (polygon.group == wanted) polygons.push_back(polygon.corners);
    if (polygons.empty()) throw toml_.error(node.source(), fmt::format("group '{}' has no faces", name));
    return polygons;
  }

  void read_surface() {
    const toml::node& surface = require("surface", {});
    const std::vector<Polygon> polygons = polygons_of(surface);
    SurfaceGrid grid;
    grid.normal = toml_.direction(require("normal", "to which side light is measured, as [0, 0, 1]"),
                                  "receiver normal");
    if (const toml::node* const node = table_.get("offset")) grid.offset = within(*node, "receiver offset");
    if (const toml::node* const node = table_.get("border")) {
      grid.border = toml_.number(*node, "receiver border");
      if (!(grid.border >= 0)) throw toml_.error(node->source(), "receiver border is below 0 m");
    }
    if (const toml::node* const node = table_.get("spacing")) {
      if (const toml::node* const cells = table_.get("cells"))
        throw toml_.error(cells->source(), "receiver cells and spacing say the same",
                          "leave out one of them");
      grid.spacing = length_of(*node, "receiver spacing");
    } else {
      read_cells();
    }
    if (const std::optional<std::string> fault = lay_on_surface(polygons, grid, receiver_))
      throw toml_.error(surface.source(), fmt::format("receiver '{}': surface '{}' {}", receiver_.name,
                                                      toml_.text(surface, "receiver surface"), *fault));
  }

  void add_point(const glm::dvec3& point) {
    receiver_.points.push_back(point);
    receiver_.columns = static_cast<int>(receiver_.points.size());
  }

  void read_points() {
    const toml::node& node = require("points", {});
    if (!node.is_array() || node.as_array()->empty() || node.as_array()->size() > kMaxReceiverCells)
      throw toml_.error(node.source(),
                        "receiver points must be an array of points, as [[1, 1, 0.8], [2, 1, 0.8]]");
    for (const toml::node& point : *node.as_array()) add_point(toml_.point(point, "receiver point"));
  }

  void read_line() {
    constexpr std::int64_t kMostPoints = 65536;
    const std::string needs = "a line needs from, to and count";
    const toml::node& count = require("count", needs);
    const glm::dvec3 from = toml_.point(require("from", needs), "receiver from");
    const glm::dvec3 to = toml_.point(require("to", needs), "receiver to");
    const std::int64_t points = count.is_integer() ? count.as_integer()->get() : 0;
    if (points < 2 || points > kMostPoints)
      throw toml_.error(count.source(),
                        fmt::format("receiver count must be a whole number from 2 to {}", kMostPoints));
    if (from == to) throw wrong("is a line of no length");
    for (std::int64_t k = 0; k < points; ++k)
      add_point(from + static_cast<double>(k) / static_cast<double>(points - 1) * (to - from));
  }

  void read_directions() {
    const Quantity quantity = receiver_.quantity;
    const bool cylinder = quantity == Quantity::cylindrical || quantity == Quantity::semicylindrical;
    if (!cylinder) refuse({"axis"}, "without a cylinder");
    if (quantity != Quantity::semicylindrical) refuse({"facing"}, "without half a cylinder");
    if (quantity != Quantity::radiance) refuse({"direction", "angle"}, "for irradiance");
    const bool has_normal = quantity == Quantity::irradiance && !receiver_.is_grid();
    if (!has_normal && !table_.contains("surface")) refuse({"normal"}, "here");
    if (has_normal)
      receiver_.direction = toml_.direction(
          require("normal", "to which side light is measured, as [0, 0, 1]"), "receiver normal");
    if (cylinder) {
      receiver_.direction = toml_.direction(require("axis", "the cylinder's, as [0, 0, 1]"), "receiver axis");
      const glm::dvec3 any =
          std::abs(receiver_.direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
      receiver_.facing = *beside(receiver_.direction, any);
    }
    if (quantity == Quantity::semicylindrical)
      receiver_.facing = toml_.direction_beside(
          receiver_.direction, require("facing", "to where half a cylinder looks, as [1, 0, 0]"),
          "receiver facing", "its axis");
    if (quantity == Quantity::radiance) read_cone();
  }

  void read_cone() {
    receiver_.direction =
        toml_.direction(require("direction", "to where radiance is measured"), "receiver direction");
    const toml::node& node = require("angle", "the whole angle of the cone in degrees, as 1");
    const double angle = toml_.number(node, "receiver angle");
    if (!(angle > 0 && angle <= 180))
      throw toml_.error(node.source(), "receiver angle must be greater than 0 and at most 180 degrees");
    receiver_.half_angle = angle / 360 * std::numbers::pi;
  }

  const TomlFile& toml_;
  const toml::table& table_;
  const SceneInput& scene_;
  Receiver receiver_;
};

}  // namespace

void read_receivers(const TomlFile& toml, const toml::node& node, SceneInput& scene) {
  if (!node.is_array()) throw toml.error(node.source(), "receivers must stand as [[receivers]]");
  for (const toml::node& receiver : *node.as_array())
    scene.receivers.push_back(ReceiverTable(toml, toml.table(receiver, "[[receivers]]"), scene).read());
}

}  // namespace fluxel

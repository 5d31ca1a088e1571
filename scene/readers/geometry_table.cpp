#include "scene/readers/geometry_table.hpp"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace fluxel {
namespace {

// A determinant of such scales neither vanishes nor overflows, and its sign tells of mirrors.
constexpr double kMinScale = 1e-9, kMaxScale = 1e9;

/// The matrix of x, y and z stretched apart.
glm::dmat3 stretched(const glm::dvec3& scale) {
  glm::dmat3 matrix(0);
  for (int i = 0; i < 3; ++i) matrix[i][i] = scale[i];
  return matrix;
}

glm::dmat3 read_mirror(const TomlFile& toml, const toml::node& node) {
  const std::string axis = toml.text(node, "mirror");
  const std::size_t i = axis.size() == 1 ? std::string_view("xyz").find(axis) : std::string::npos;
  if (i == std::string::npos)
    throw toml.error(node.source(), fmt::format("mirror is '{}'", axis),
                     "x, y or z: the axis whose coordinates change their sign");
  glm::dvec3 sign(1);
  sign[static_cast<int>(i)] = -1;
  return stretched(sign);
}

glm::dmat3 read_scale(const TomlFile& toml, const toml::node& node) {
  const glm::dvec3 scale =
      node.is_array() ? toml.vector(node, "scale") : glm::dvec3(toml.number(node, "scale"));
  for (int i = 0; i < 3; ++i) {
    const double factor = std::abs(scale[i]);
    if (factor < kMinScale || factor > kMaxScale)
      throw toml.error(node.source(), fmt::format("scale is {}", scale[i]),
                       fmt::format("{:g} to {:g}, or the same below 0, which mirrors", kMinScale, kMaxScale));
  }
  return stretched(scale);
}

/// Quarter turns are exact: only what is left of them goes through sine and cosine.
glm::dmat3 turn(const glm::dvec3& axis, double degrees) {
  const double turns = std::round(degrees / 90);
  const double rest = glm::radians(std::remainder(degrees, 90));
  const double c0 = std::cos(rest), s0 = std::sin(rest);
  const auto quarter = static_cast<int>(turns - 4 * std::floor(turns / 4));
  const double c = quarter == 0 ? c0 : quarter == 1 ? -s0 : quarter == 2 ? -c0 : s0;
  const double s = quarter == 0 ? s0 : quarter == 1 ? c0 : quarter == 2 ? -s0 : -c0;
  // Rodrigues (1840).
  const glm::dmat3 cross(0, axis.z, -axis.y, -axis.z, 0, axis.x, axis.y, -axis.x, 0);
  return glm::dmat3(c) + (1 - c) * glm::outerProduct(axis, axis) + s * cross;
}

glm::dmat3 read_turn(const TomlFile& toml, const toml::node& node) {
  constexpr double kMaxDegrees = 36000;  // beyond, the rest of a turn has lost its digits
  const auto fault = [&](const std::string& what) {
    return toml.error(node.source(), "rotate " + what,
                      "[axis_x, axis_y, axis_z, degrees], or a list of such, which are applied in order");
  };
  if (!node.is_array() || node.as_array()->size() != 4) throw fault("must be four numbers");
  const toml::array& values = *node.as_array();
  glm::dvec3 axis;
  for (int i = 0; i < 3; ++i) axis[i] = toml.number(values[static_cast<std::size_t>(i)], "rotate");
  const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
  if (largest == 0) throw fault("has an axis of 0");
  const double degrees = toml.number(values[3], "rotate");
  if (std::abs(degrees) > kMaxDegrees)
    throw fault(fmt::format("by {} degrees is beyond {:g}", degrees, kMaxDegrees));
  return turn(glm::normalize(axis / largest), degrees);
}

glm::dmat3 read_rotate(const TomlFile& toml, const toml::node& node) {
  const bool several = node.is_array() && !node.as_array()->empty() && node.as_array()->front().is_array();
  if (!several) return read_turn(toml, node);
  glm::dmat3 all(1);
  for (const toml::node& one : *node.as_array()) all = read_turn(toml, one) * all;
  return all;
}

}  // namespace

InputGeometry read_placing(const TomlFile& toml, const toml::table& table) {
  toml.require_known_keys(table, "[[geometry]]",
                          {"file", "box", "rectangle", "inwards", "group", "material", "material_of",
                           "mirror", "scale", "rotate", "metres_per_unit", "translate"});
  InputGeometry geometry;
  if (const toml::node* const value = table.get("mirror")) geometry.linear = read_mirror(toml, *value);
  if (const toml::node* const value = table.get("scale"))
    geometry.linear = read_scale(toml, *value) * geometry.linear;
  if (const toml::node* const value = table.get("rotate"))
    geometry.linear = read_rotate(toml, *value) * geometry.linear;
  if (const toml::node* const value = table.get("metres_per_unit")) {
    geometry.metres_per_unit = toml.number(*value, "metres_per_unit");
    geometry.unit_given = true;
    if (geometry.metres_per_unit <= 0)
      throw toml.error(value->source(), "metres_per_unit must be greater than 0");
  }
  if (const toml::node* const value = table.get("translate"))
    geometry.translate = toml.vector(*value, "translate");
  return geometry;
}

}  // namespace fluxel

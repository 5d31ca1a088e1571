#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "formfactor/surface_exchange.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/test_scenes.hpp"

/// Rooms with what stands in them, a group a polygon.
namespace fluxel::random_rooms {

/// A box from the inside, in each quarter of it perhaps a box apart from all, one that stands on the floor,
/// at a wall or in the corner, a turned box, or a shelf or slanted sheet with one side. Coordinates have 2,
/// 3, 6 or all decimals; a room in two stands far from the origin.
class Room {
 public:
  std::vector<closed_forms::Polygon> polygons;  // parallelograms
  std::vector<std::string> names;
  bool closed = true;  // no side of a sheet swallows what reaches it
  double size = 0;     // [m]

  explicit Room(std::mt19937& random) : random_(random) {
    constexpr std::array kDecimals{2, 3, 6, 17};
    decimals_ = kDecimals[random() % kDecimals.size()];
    const glm::dvec3 extent(within(2.5, 6), within(2.5, 6), within(2.2, 4));
    size = std::max({extent.x, extent.y, extent.z});
    add("room", closed_forms::reversed(closed_forms::box(glm::dvec3(0), extent)));
    const glm::dvec3 middle(rounded(extent.x / 2), rounded(extent.y / 2), extent.z);
    for (int quarter = 0; quarter < 4; ++quarter) {
      glm::dvec3 low(0), high = middle;
      if ((quarter & 1) != 0) low.x = middle.x, high.x = extent.x;
      if ((quarter & 2) != 0) low.y = middle.y, high.y = extent.y;
      furnish(std::to_string(quarter), low, high);
    }
    const double far = random() % 2 == 0 ? 0 : std::pow(10, within(0, 4));
    const glm::dvec3 shift(rounded(far), rounded(-far / 3), rounded(far / 7));
    for (closed_forms::Polygon& polygon : polygons)
      for (glm::dvec3& corner : polygon) corner += shift;
  }

  [[nodiscard]] Scene scene(bool cut) const {
    SceneInput input;
    input.materials = {{"black", Rgb(0), Rgb(0), std::nullopt, std::nullopt}};
    for (std::size_t k = 0; k < polygons.size(); ++k) {
      input.groups.push_back(names[k]);
      input.polygons.push_back({polygons[k], MaterialId{0}, GroupId{static_cast<std::uint32_t>(k)}});
    }
    SceneSettings settings{Sides::one, KeMeaning::exitance, cut, std::nullopt};
    settings.seal = false;
    return build_scene(input, settings);
  }

 private:
  [[nodiscard]] double rounded(double x) const {
    if (decimals_ > 15) return x;
    const double unit = std::pow(10, decimals_);
    return std::round(x * unit) / unit;
  }
  [[nodiscard]] double within(double low, double high) {
    return rounded(test_scenes::uniform(random_, low, high));
  }

  void add(const std::string& name, const std::vector<closed_forms::Polygon>& faces) {
    for (std::size_t k = 0; k < faces.size(); ++k) {
      polygons.push_back(faces[k]);
      names.push_back(name + "." + std::to_string(k));
    }
  }

  /// In the box between two corners.
  void furnish(const std::string& name, const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 span = high - low;
    glm::dvec3 from, to;
    for (int axis = 0; axis < 3; ++axis) {
      from[axis] = rounded(low[axis] + test_scenes::uniform(random_, 0.05, 0.4) * span[axis]);
      to[axis] = rounded(low[axis] + test_scenes::uniform(random_, 0.5, 0.95) * span[axis]);
    }
    switch (random_() % 6) {
      case 0:
        break;
      case 1:
        add("apart " + name, closed_forms::box(from, to));
        break;
      case 2:
        stand(low, high, from, to);
        add("standing " + name, closed_forms::box(from, to));
        break;
      case 3:
        add("turned " + name, turned(from, to));
        break;
      case 4:
        add("shelf " + name, {closed_forms::horizontal({from.x, to.x, from.y, to.y}, to.z)});
        closed = false;
        break;
      default: {
        const glm::dvec3 along(to.x - from.x, 0, to.z - from.z), across(0, to.y - from.y, 0);
        add("slanted " + name, {{from, from + along, from + along + across, from + across}});
        closed = false;
      }
    }
  }

  /// On the floor, and perhaps against the walls of its quarter.
  void stand(const glm::dvec3& low, const glm::dvec3& high, glm::dvec3& from, glm::dvec3& to) {
    from.z = low.z;
    for (int axis = 0; axis < 2; ++axis) {
      if (random_() % 2 == 0) continue;
      if (low[axis] == 0)
        from[axis] = low[axis];
      else
        to[axis] = high[axis];
    }
  }

  /// Within the circle that the box's base holds.
  std::vector<closed_forms::Polygon> turned(const glm::dvec3& from, const glm::dvec3& to) {
    std::vector<closed_forms::Polygon> faces = closed_forms::box(from, to);
    const glm::dvec3 middle = 0.5 * (from + to);
    const double angle = test_scenes::uniform(random_, 0, std::numbers::pi / 2);
    const double scale = std::min(to.x - from.x, to.y - from.y) / std::hypot(to.x - from.x, to.y - from.y);
    for (closed_forms::Polygon& face : faces) {
      for (glm::dvec3& corner : face) {
        const double x = scale * (corner.x - middle.x), y = scale * (corner.y - middle.y);
        corner.x = middle.x + std::cos(angle) * x - std::sin(angle) * y;
        corner.y = middle.y + std::sin(angle) * x + std::cos(angle) * y;
      }
    }
    return faces;
  }

  std::mt19937& random_;
  int decimals_ = 0;
};

}  // namespace fluxel::random_rooms

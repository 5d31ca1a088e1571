#include "bench/stability/rooms.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "tests/closed_forms/polygons.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::lab {

void add_box(SceneInput& input, const std::string& group, double rho, double E, const glm::dvec3& low,
             const glm::dvec3& high, bool outward) {
  const std::vector<closed_forms::Polygon> faces = closed_forms::box(low, high);
  for (const closed_forms::Polygon& face : outward ? faces : closed_forms::reversed(faces))
    add_polygon(input, group, rho, E, face);
}

glm::dquat random_rotation(unsigned number) {
  std::mt19937_64 random(number);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double u = uniform(), a = 2 * 3.14159265358979323846 * uniform(),
               b = 2 * 3.14159265358979323846 * uniform();
  return {std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a), std::sqrt(u) * std::sin(b),
          std::sqrt(u) * std::cos(b)};
}

void transform(SceneInput& input, const glm::dquat& rotation, double scale, const glm::dvec3& shift) {
  for (InputPolygon& polygon : input.polygons)
    for (glm::dvec3& x : polygon.corners) x = scale * (rotation * x) + shift;
}

void make_furnace(Setup& setup) {
  setup.adjust = [](const ElementMesh& mesh, Unknowns& unknowns) {
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      if (unknowns.area[i] == 0) continue;
      std::mt19937_64 random(index(mesh.elements[i % unknowns.elements].patch));
      const double rho = 0.9 * static_cast<double>(random() >> 11) * 0x1p-53;
      unknowns.rho[i] = Rgb(rho);
      unknowns.E[i] = Rgb(1 - rho);
    }
  };
}

double furnace_error(const Run& run) {
  double worst = 0;
  for (std::size_t i = 0; i < run.unknowns.size(); ++i) {
    if (run.unknowns.area[i] == 0) continue;
    const double off = std::abs(run.radiosity.B[i].r - 1);
    worst = std::isfinite(off) ? std::max(worst, off) : std::numeric_limits<double>::infinity();
  }
  return worst;
}

double largest_escape_fraction(const Run& run) {
  float most = 0;
  for (const SideView& view : run.views) most = std::max(most, view.escape);
  return static_cast<double>(most);
}

DarkRoom dark_room(Wall wall, double thickness, Sides sides, unsigned rotation) {
  constexpr double kLength = 8;
  DarkRoom room;
  room.setup.sides = wall == Wall::sheet ? Sides::two : wall == Wall::two_faces ? Sides::one : sides;
  room.setup.subdivision = Subdivision::uniform;
  room.setup.max_edge = 1.5;
  SceneInput& input = room.setup.input;
  add_box(input, "shell", 0.5, 0, {0, 0, 0}, {kLength, 4, 3}, false);
  InputPolygon& lit_end = input.polygons[4];  // x = 0
  input.materials.push_back({.name = "light", .rho = Rgb(0.5), .Ke = Rgb(1), .E = {}, .sides = {}});
  lit_end.material = MaterialId{static_cast<std::uint32_t>(input.materials.size() - 1)};

  const glm::dvec3 a{3, 0, 0}, b{4, 4, 0}, up{0, 0, 3};
  const glm::dvec3 to_dark = glm::normalize(glm::cross(b - a, up));
  // Along x, so that the wall's ends stay in the room's own walls.
  const glm::dvec3 through{wall == Wall::sheet ? 0 : kLength * thickness, 0, 0};
  const glm::dvec3 c = a + through, d = b + through;
  const auto add = [&](const std::vector<glm::dvec3>& corners) {
    add_polygon(input, "wall", 0.4, 0, corners);
  };
  add({a, a + up, b + up, b});
  if (wall != Wall::sheet) add({c, d, d + up, c + up});
  if (wall == Wall::box && thickness > 0) {
    add({a, b, d, c});
    add({a + up, c + up, d + up, b + up});
    add({a, c, c + up, a + up});
    add({b, b + up, d + up, d});
  }
  const glm::dquat turn = random_rotation(rotation);
  transform(input, turn, 1, glm::dvec3(0));
  room.dark_face = {turn * c, turn * to_dark};
  return room;
}

double leak(const DarkRoom& room, const Run& run) {
  const glm::dvec3 beyond = room.dark_face.point - run.scene.origin + 1e-4 * room.dark_face.normal;
  const std::size_t elements = run.mesh.elements.size();
  double sum = 0, dark_area = 0;
  for (std::size_t unknown = 0; unknown < run.unknowns.size(); ++unknown) {
    if (run.unknowns.area[unknown] == 0) continue;
    const std::size_t i = unknown % elements;
    const Patch& patch = run.scene.patch(run.mesh.elements[i].patch);
    double area = 0;
    if (run.scene.groups[index(patch.group)] == "wall") {
      const glm::dvec3 normal = unknown < elements ? patch.normal : -patch.normal;
      if (glm::dot(normal, room.dark_face.normal) > 0.5) area = run.unknowns.area[unknown];
    } else {
      const Outline<glm::dvec3> outline = widen(run.mesh.outlines[i]);
      const PolygonView view = corners(outline);
      const auto dark_part = closed_forms::clip({view.begin(), view.end()}, beyond, room.dark_face.normal);
      if (dark_part.size() > 2) area = closed_forms::area(dark_part);
    }
    sum += area * run.radiosity.B[unknown].r;
    dark_area += area;
  }
  return sum / dark_area;
}

}  // namespace fluxel::lab

#include "scene/readers/placing.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <utility>

namespace fluxel {

namespace {

/// What brings a file's points and directions into the scene.
struct Placing {
  explicit Placing(const InputGeometry& geometry)
      : linear(geometry.metres_per_unit * geometry.linear),
        translate(geometry.translate),
        mirrors(glm::determinant(geometry.linear) < 0) {}

  [[nodiscard]] glm::dvec3 point(const glm::dvec3& p) const { return linear * p + translate; }
  [[nodiscard]] glm::dvec3 direction(const glm::dvec3& d) const { return glm::normalize(linear * d); }

  void place(InputPolygon& polygon) const {
    for (glm::dvec3& corner : polygon.corners) corner = point(corner);
    if (mirrors) std::ranges::reverse(polygon.corners);  // the front stays the front
  }
  void place(InputCamera& camera) const {
    if (camera.eye) camera.eye->value = point(camera.eye->value);
    if (camera.look_at) camera.look_at->value = point(camera.look_at->value);
    if (camera.up) camera.up->value = direction(camera.up->value);
  }
  void place(Luminaire& luminaire) const {
    luminaire.position = point(luminaire.position);
    luminaire.size *= glm::dvec2(glm::length(linear * luminaire.ahead),
                                 glm::length(linear * glm::cross(luminaire.ahead, luminaire.aim)));
    luminaire.aim = direction(luminaire.aim);
    const glm::dvec3 ahead = direction(luminaire.ahead);
    luminaire.ahead = glm::normalize(ahead - glm::dot(ahead, luminaire.aim) * luminaire.aim);
  }
  /// A mirrored lamp's light turns about its axis the other way.
  void place(IntensityTable& table) const {
    if (!mirrors || table.C.size() < 2) return;
    IntensityTable turned = table;
    const std::size_t last = table.C.size() - 1, angles = table.gamma.size();
    for (std::size_t c = 0; c <= last; ++c) {
      turned.C[c] = 2 * std::numbers::pi - table.C[last - c];
      for (std::size_t g = 0; g < angles; ++g) turned.intensity[c * angles + g] = table.at(last - c, g);
    }
    table = std::move(turned);
  }

  glm::dmat3 linear;
  glm::dvec3 translate;
  bool mirrors;
};

}  // namespace

void place(SceneInput& part, const InputGeometry& geometry) {
  const Placing placing(geometry);
  for (InputPolygon& polygon : part.polygons) placing.place(polygon);
  for (InputCamera& camera : part.cameras) placing.place(camera);
  for (Luminaire& luminaire : part.luminaires) placing.place(luminaire);
  for (IntensityTable& table : part.intensities) placing.place(table);
}

}  // namespace fluxel

#include "optics/luminaire_openings.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "optics/luminaire_intensity.hpp"

namespace fluxel {

LuminaireOpenings::LuminaireOpenings(const RayScene& ray_scene)
    : lift_(static_cast<double>(ray_scene.surface_epsilon())) {
  const Scene& scene = ray_scene.scene();
  for (const Luminaire& of : scene.luminaires) {
    const double area = of.size.x * of.size.y * (of.round ? std::numbers::pi / 4 : 1);
    if (area > 0) openings_.push_back({&of, &scene.intensity(of), glm::cross(of.ahead, of.aim), area});
  }
}

Rgb LuminaireOpenings::radiance(const Ray& ray, double end) const {
  Rgb sum(0);
  for (const Opening& opening : openings_) {
    const Luminaire& of = *opening.luminaire;
    const double along = glm::dot(ray.direction, of.aim), cosine = std::abs(along);
    if (!(cosine > 0)) continue;
    const double distance = glm::dot(of.position - ray.origin, of.aim) / along;
    // A ray from the opening starts lifted off its plane, to the side that it goes to.
    if (!(distance > 0 && distance - lift_ / cosine <= end)) continue;
    const glm::dvec3 from_centre = ray.origin + distance * ray.direction - of.position;
    const glm::dvec2 on(glm::dot(from_centre, of.ahead) / of.size.x,
                        glm::dot(from_centre, opening.across) / of.size.y);
    const bool is_met = of.round ? glm::dot(on, on) <= 0.25 : std::abs(on.x) <= 0.5 && std::abs(on.y) <= 0.5;
    if (!is_met) continue;
    const double intensity = intensity_along(-ray.direction, 1, of, opening.across, *opening.table);
    sum += of.scale * (intensity / (opening.area * cosine));
  }
  return sum;
}

}  // namespace fluxel

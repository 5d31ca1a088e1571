#include "hierarchy/ray_light.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/sampling.hpp"

namespace fluxel {

RayLight::RayLight(const RayScene& ray_scene, const NodeTree& tree, int threads, const Ranks& ranks)
    : ray_scene_(ray_scene),
      tree_(tree),
      first_side_(ray_scene),
      pieces_(tree.scene()),
      emitters_(tree, ray_scene, threads, ranks),
      luminaires_(ray_scene) {}

Ray RayLight::hemisphere_ray(const ReceivingPoint& at, double u, double v) const {
  return {at.position + static_cast<double>(ray_scene_.surface_epsilon()) * at.normal,
          cosine_direction(u, v, at.normal)};
}

MetLeaf RayLight::end_of(const Ray& ray, const PatchHit& hit) const {
  const MetSide met = first_side_.meet(ray, hit);
  if (met.patch == kNoPatch || !met.active) return {};
  const glm::dvec3 point = ray.origin + met.t * ray.direction;
  return {tree_.leaf_below(tree_.face(pieces_.find(met.patch, point), met.front), point), point};
}

double RayLight::kernel(const ReceivingPoint& at, const glm::dvec3& of, const glm::dvec3& normal) {
  const glm::dvec3 way = of - at.position;
  const double squared = glm::dot(way, way);
  const double in = glm::dot(at.normal, way), out = -glm::dot(normal, way);
  return in > 0 && out > 0 ? in * out / (std::numbers::pi * squared * squared) : 0;
}

}  // namespace fluxel

#include "visibility/first_side.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

#include "scene/polygon.hpp"

namespace fluxel {

FirstSide::FirstSide(const RayScene& ray_scene) : ray_scene_(ray_scene) {
  const Scene& scene = ray_scene.scene();
  std::vector<double> uncovered(scene.patches.size(), 0.0);
  for (const Piece& piece : scene.pieces) uncovered[index(piece.patch)] += area(corners(piece.outline));
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    covered_.push_back(uncovered[i] < scene.patches[i].area * (1 - 1e-9));
}

MetSide FirstSide::side_of(const PatchHit& hit, const glm::dvec3& direction) const {
  const Patch& patch = ray_scene_.scene().patch(hit.patch);
  const bool front = glm::dot(patch.normal, direction) < 0;
  return {hit.patch, front, (patch.sides & (front ? kFront : kBack)) != 0, hit.t};
}

MetSide FirstSide::meet(const glm::dvec3& origin, const glm::dvec3& direction) const {
  return meet(Ray{origin, direction}, ray_scene_.first_hit(origin, direction));
}

void FirstSide::meet(std::span<const Ray> rays, std::span<MetSide> met) const {
  std::array<PatchHit, RayPacket::kSize> hits;
  for (std::size_t first = 0; first < rays.size(); first += hits.size()) {
    const auto some = rays.subspan(first, std::min(hits.size(), rays.size() - first));
    ray_scene_.first_hits(some, hits);
    for (std::size_t k = 0; k < some.size(); ++k) met[first + k] = meet(some[k], hits[k]);
  }
}

MetSide FirstSide::meet(const Ray& ray, const PatchHit& hit) const {
  const glm::dvec3& origin = ray.origin;
  const glm::dvec3& direction = ray.direction;
  if (hit.patch == kNoPatch) return {};
  const MetSide first = side_of(hit, direction);
  const Scene& scene = ray_scene_.scene();
  // One of both sides that is left out looks into the dark, whatever lies close behind it.
  const bool is_sealed = !first.active && scene.material(scene.patch(hit.patch)).sides == Sides::two;
  if ((first.active || is_sealed) && !is_covered(hit.patch)) return first;

  const double cosine = std::abs(glm::dot(scene.patch(hit.patch).normal, direction));
  thread_local std::vector<PatchHit> hits;
  hits.clear();
  ray_scene_.all_hits(origin, direction,
                      hit.t + 2 * static_cast<double>(ray_scene_.surface_epsilon()) / cosine, hits);
  const auto rank = [&](const PatchHit& of) {
    return std::tuple(!side_of(of, direction).active, !scene.patch(of.patch).covers_emitter,
                      !scene.emits(of.patch), of.patch);
  };
  const auto best = std::ranges::min_element(hits, {}, rank);
  return best == hits.end() ? first : side_of(*best, direction);
}

}  // namespace fluxel

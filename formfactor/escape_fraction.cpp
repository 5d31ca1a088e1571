#include "formfactor/escape_fraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

#include "core/sampling.hpp"

namespace fluxel {

namespace {

/// Uniform in [0, 1) from the generator's top 53 bits; the standard's distributions differ between libraries.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::array<int, kEscapeRays> shuffled_strata(std::mt19937_64& random) {
  std::array<int, kEscapeRays> order;
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = order.size() - 1; k > 0; --k) std::swap(order[k], order[random() % (k + 1)]);
  return order;
}

/// True where a ray ends on a side that is an unknown: of the patch that it met first, or of one that
/// coincides with it there.
bool ends_on_unknown(const RayScene& ray_scene, const Scene& scene, const glm::dvec3& origin,
                     const glm::dvec3& direction, const PatchHit& first) {
  const auto shows_unknown = [&](PatchId id) {
    const Patch& patch = scene.patch(id);
    return (patch.sides & (glm::dot(patch.normal, direction) < 0 ? kFront : kBack)) != 0;
  };
  if (shows_unknown(first.patch)) return true;
  // Which of two sheets back to back a ray meets first is chance.
  const double cosine = std::abs(glm::dot(scene.patch(first.patch).normal, direction));
  std::vector<PatchHit> hits;
  ray_scene.all_hits(origin, direction, first.t + static_cast<double>(ray_scene.surface_epsilon()) / cosine,
                     hits);
  return std::ranges::any_of(hits, [&](const PatchHit& hit) { return shows_unknown(hit.patch); });
}

SideView view_of(const RayScene& ray_scene, const Scene& scene, const Outline<glm::vec3>& outline,
                 const glm::dvec3& normal, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::array<int, kEscapeRays> origin_stratum = shuffled_strata(random);
  const auto in_stratum = [&random](int stratum) {
    const std::div_t cell = std::div(stratum, kEscapeStrata);
    const double u = (cell.rem + uniform(random)) / kEscapeStrata;
    return std::pair(u, (cell.quot + uniform(random)) / kEscapeStrata);
  };
  int escaped = 0, dark = 0;
  for (int k = 0; k < kEscapeRays; ++k) {
    const auto [u, v] = in_stratum(k);
    const auto [s, t] = in_stratum(origin_stratum[static_cast<std::size_t>(k)]);
    const glm::dvec3 direction = cosine_direction(u, v, normal);
    // Lifted off its own plane rather than started further along: a grazing ray beside an edge would then
    // begin behind the next wall.
    const glm::dvec3 origin =
        surface_point(outline, s, t) + static_cast<double>(ray_scene.surface_epsilon()) * normal;
    const PatchHit hit = ray_scene.first_hit(origin, direction);
    if (hit.patch == kNoPatch) {
      ++escaped;
    } else if (!ends_on_unknown(ray_scene, scene, origin, direction, hit)) {
      ++dark;
    }
  }
  return {static_cast<float>(escaped) / kEscapeRays, static_cast<float>(dark) / kEscapeRays};
}

}  // namespace

SideView side_view(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh,
                   std::size_t element, bool front) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(mesh.elements[element].normal));
  return view_of(ray_scene, scene, mesh.outlines[element], front ? normal : -normal,
                 2 * element + (front ? 0 : 1));
}

void side_views(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh, std::size_t first,
                std::size_t last, const SideViewSpans& views) {
  for (std::size_t i = first; i < last; ++i) {
    const std::uint32_t sides = mesh.elements[i].sides;
    if ((sides & kFront) != 0) views.front[i - first] = side_view(ray_scene, scene, mesh, i, true);
    if ((sides & kBack) != 0) views.back[i - first] = side_view(ray_scene, scene, mesh, i, false);
  }
}

bool is_closed(std::span<const SideView> views) {
  return std::ranges::all_of(views, [](const SideView& view) { return view.escape == 0; });
}

}  // namespace fluxel

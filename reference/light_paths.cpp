#include "reference/light_paths.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/sampling.hpp"
#include "reference/cuda/path_rules.hpp"
#include "reference/leaving_side.hpp"

namespace fluxel {

namespace {

/// With a solution to guide them: of the paths' first rays, those that go to points drawn by its light.
constexpr double kGuided = 0.25;

}  // namespace

LightPaths::LightPaths(const RayScene& ray_scene, const FinishedLight* finished)
    : ray_scene_(ray_scene),
      first_side_(ray_scene),
      finished_(finished),
      guides_(finished != nullptr && finished->draw(0.5, 0.5).has_value()),
      emitters_(ray_scene.scene()),
      luminaires_(ray_scene),
      openings_(ray_scene) {
  const Scene& scene = ray_scene.scene();
  sides_.reserve(scene.patches.size());
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const PatchId id{static_cast<std::uint32_t>(i)};
    sides_.push_back({leaving_side(scene, id, true), leaving_side(scene, id, false)});
  }
}

bool LightPaths::scatters() const {
  return std::ranges::any_of(sides_, [](const std::array<SideLight, 2>& sides) {
    return std::ranges::any_of(sides,
                               [](const SideLight& of) { return of.rho != Rgb(0) || !of.is_diffuse(); });
  });
}

glm::dvec3 LightPaths::lifted(const LitPoint& at) const {
  return at.position + static_cast<double>(ray_scene_.surface_epsilon()) * at.normal;
}

void LightPaths::first_seen(std::span<const Ray> rays, std::span<Seen> seen) const {
  std::array<MetSide, RayPacket::kSize> met;
  for (std::size_t first = 0; first < rays.size(); first += met.size()) {
    const auto some = rays.subspan(first, std::min(met.size(), rays.size() - first));
    first_side_.meet(some, met);
    for (std::size_t k = 0; k < some.size(); ++k) {
      seen[first + k] = {};
      if (met[k].patch == kNoPatch) continue;
      const glm::dvec3& normal = ray_scene_.scene().patch(met[k].patch).normal;
      seen[first + k] = {{some[k].origin + met[k].t * some[k].direction, met[k].front ? normal : -normal},
                         &sides_[index(met[k].patch)][met[k].front ? 0 : 1],
                         met[k].patch,
                         met[k].front};
    }
  }
}

double LightPaths::density_of_next(double kernel, const DrawnPoint& point, bool is_guided) const {
  if (!is_guided) return kernel;
  return (1 - kGuided) * kernel + kGuided * finished_->density(point.patch, point.front, point.position);
}

std::optional<LightPaths::Lit> LightPaths::lit_by(const LitPoint& at, std::array<double, 2> light,
                                                  bool is_guided) const {
  if (emitters_.empty()) return std::nullopt;
  const EmitterPoint emitter = emitters_.point(light[0], light[1]);
  const double kernel = cuda::kernel_between(at.position, at.normal, emitter.position, emitter.normal);
  if (!(kernel > 0)) return std::nullopt;
  const double next = density_of_next(kernel, {emitter.position, emitter.patch, emitter.front}, is_guided);
  const double drawn = emitters_.density(emitter.E);
  return Lit{lifted({emitter.position, emitter.normal}),
             emitter.E * cuda::share_of_drawn(kernel, next, drawn)};
}

std::optional<LightPaths::Heading> LightPaths::heading(const LitPoint& at, double u, double v,
                                                       bool is_guided) const {
  if (!is_guided || u >= kGuided)
    return Heading{cosine_direction(is_guided ? (u - kGuided) / (1 - kGuided) : u, v, at.normal), {}};
  const std::optional<DrawnPoint> drawn = finished_->draw(u / kGuided, v);
  const glm::dvec3 direction = glm::normalize(drawn->position - at.position);
  if (!(glm::dot(at.normal, direction) > 0)) return std::nullopt;
  return Heading{direction, drawn};
}

std::optional<LightPaths::Next> LightPaths::next(const LitPoint& at, const Heading& to, const Seen& met,
                                                 bool is_guided) const {
  if (!met.is_active()) return std::nullopt;
  // Else something stands before the point that was drawn.
  if (to.drawn && (met.patch != to.drawn->patch || met.front != to.drawn->front)) return std::nullopt;
  const double kernel =
      cuda::kernel_along(at.position, at.normal, to.direction, met.at.position, met.at.normal);
  return Next{kernel, density_of_next(kernel, {met.at.position, met.patch, met.front}, is_guided)};
}

}  // namespace fluxel

#include "reference/light_paths.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/sampling.hpp"

namespace fluxel {

namespace {

/// Where nothing is absorbed and nothing escapes no path would end.
constexpr double kMaxSurvival = 0.999;

/// With a solution as control, paths of at least this weight go on.
constexpr double kSpared = 0.3;

/// Of their first rays, those that go to points drawn by the solution's light.
constexpr double kGuided = 0.25;

double largest_channel(const Rgb& weight) { return std::max({weight.r, weight.g, weight.b}); }

}  // namespace

LightPaths::LightPaths(const RayScene& ray_scene, const FinishedLight* finished, PathEnd end)
    : ray_scene_(ray_scene),
      first_side_(ray_scene),
      finished_(finished),
      end_(end),
      guides_(finished != nullptr && end == PathEnd::roulette && finished->draw(0.5, 0.5).has_value()),
      emitters_(ray_scene.scene()) {
  const Scene& scene = ray_scene.scene();
  sides_.reserve(scene.patches.size());
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const PatchId id{static_cast<std::uint32_t>(i)};
    sides_.push_back({side_light(scene, id, true), side_light(scene, id, false)});
  }
}

glm::dvec3 LightPaths::lifted(const LitPoint& at) const {
  return at.position + static_cast<double>(ray_scene_.surface_epsilon()) * at.normal;
}

std::optional<LightPaths::Met> LightPaths::first_met(const glm::dvec3& origin,
                                                     const glm::dvec3& direction) const {
  const MetSide met = first_side_.meet(origin, direction);
  if (met.patch == kNoPatch) return std::nullopt;
  const glm::dvec3& normal = ray_scene_.scene().patch(met.patch).normal;
  return Met{{origin + met.t * direction, met.front ? normal : -normal},
             sides_[index(met.patch)][met.front ? 0 : 1],
             met.patch,
             met.front};
}

double LightPaths::density_of_next(double kernel, const DrawnPoint& point, bool is_guided) const {
  if (!is_guided) return kernel;
  return (1 - kGuided) * kernel + kGuided * finished_->density(point.patch, point.front, point.position);
}

/// With p the density of the drawn point and q that with which the path's next ray meets it, mostly
/// K = cos cos / (pi r^2) of a cosine-distributed one, a drawn point's E K / p times its weight
/// p^2 / (p^2 + q^2) has a bound: E / 2 where q = K.
Rgb LightPaths::direct(const LitPoint& at, std::array<double, 2> light, bool is_guided,
                       std::uint64_t& rays) const {
  if (emitters_.empty()) return Rgb(0);
  const EmitterPoint emitter = emitters_.point(light[0], light[1]);
  const glm::dvec3 way = emitter.position - at.position;
  const double squared = glm::dot(way, way);
  const double out = -glm::dot(emitter.normal, way), in = glm::dot(at.normal, way);
  if (!(out > 0) || !(in > 0)) return Rgb(0);
  RayPacket packet;
  // From the emitter: what single precision rounds off a receiver that is far away must not move the end that
  // lies on a surface.
  packet.set_segment(0, glm::vec3(lifted({emitter.position, emitter.normal})), glm::vec3(lifted(at)));
  ++rays;
  if (ray_scene_.occluded(packet, 1) != 0) return Rgb(0);
  const double kernel = in * out / (std::numbers::pi * squared * squared);
  const double next = density_of_next(kernel, {emitter.position, emitter.patch, emitter.front}, is_guided);
  const double drawn = emitters_.density(emitter.E);
  return emitter.E * (kernel * drawn / (next * next + drawn * drawn));
}

std::optional<LightPaths::Next> LightPaths::next_met(const LitPoint& at, double u, double v,
                                                     bool is_guided) const {
  glm::dvec3 direction;
  std::optional<DrawnPoint> drawn;
  if (is_guided && u < kGuided) {
    drawn = finished_->draw(u / kGuided, v);
    direction = glm::normalize(drawn->position - at.position);
    if (!(glm::dot(at.normal, direction) > 0)) return std::nullopt;
  } else {
    direction = cosine_direction(is_guided ? (u - kGuided) / (1 - kGuided) : u, v, at.normal);
  }
  const std::optional<Met> met = first_met(lifted(at), direction);
  if (!met || !met->side.active) return std::nullopt;
  // Else something stands before the point that was drawn.
  if (drawn && (met->patch != drawn->patch || met->front != drawn->front)) return std::nullopt;
  const glm::dvec3 way = met->at.position - at.position;
  const double kernel = std::abs(glm::dot(at.normal, direction) * glm::dot(met->at.normal, direction)) /
                        (std::numbers::pi * glm::dot(way, way));
  return Next{*met, kernel, density_of_next(kernel, {met->at.position, met->patch, met->front}, is_guided)};
}

Rgb LightPaths::irradiance(LitPoint at, std::array<double, 2> light, OwenSobol& numbers,
                           std::uint64_t& rays) const {
  Rgb sum(0), weight(1);
  for (int met_before = 0;; ++met_before) {
    // Weights of several such rays would multiply.
    const bool is_guided = guides_ && met_before == 0;
    sum += weight * direct(at, light, is_guided, rays);
    const auto [u, v, next_u, next_v] = numbers.next();
    ++rays;
    const auto next = next_met(at, u, v, is_guided);
    if (!next) return sum;
    const Met& met = next->met;
    if (is_guided) weight *= next->density > 0 ? next->kernel / next->density : 0;
    if (const double drawn = emitters_.density(met.side.E); drawn > 0)
      sum += weight * met.side.E *
             (next->density * next->density / (next->density * next->density + drawn * drawn));
    const auto of_solution = [&] {
      return weight * finished_->reflected(met.patch, met.front, met.at.position);
    };
    const bool controlled = finished_ != nullptr && end_ == PathEnd::roulette;
    if (finished_ != nullptr && !controlled && met_before == 1) return sum + of_solution();

    const Rgb reflected = weight * met.side.rho;
    const double survival = std::min(kMaxSurvival, largest_channel(reflected) / (controlled ? kSpared : 1.0));
    const bool goes_on = numbers.next_random() < survival;
    // On average of both ends nothing is added.
    if (controlled) sum += (goes_on ? 1 - 1 / survival : 1.0) * of_solution();
    if (!goes_on) return sum;
    weight = reflected / survival;
    at = met.at;
    light = {next_u, next_v};
  }
}

Rgb LightPaths::radiance(const glm::dvec3& eye, const glm::dvec3& direction, std::array<double, 2> light,
                         OwenSobol& numbers, std::uint64_t& rays) const {
  ++rays;
  const auto met = first_met(eye, direction);
  if (!met || !met->side.active) return Rgb(0);
  return (met->side.E + met->side.rho * irradiance(met->at, light, numbers, rays)) / std::numbers::pi;
}

}  // namespace fluxel

#pragma once

#include "reference/cuda/path_rules.hpp"
#include "reference/cuda/path_scene.hpp"
#include "sampling/cuda/chosen_part.hpp"
#include "visibility/cuda/first_side.hpp"

namespace fluxel::cuda {

/// Channel by channel.
FLUXEL_PORTABLE inline Double3 filtered(const Double3& a, const Double3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// One path of light, as LightPaths follows it without a finished solution.
class LightPath {
 public:
  FLUXEL_PORTABLE LightPath(const PathScene& scene, const PathBegin& begin)
      : scene_(scene),
        at_(begin.position),
        normal_(begin.normal),
        light_{begin.light[0], begin.light[1]},
        numbers_(begin.numbers) {}

  /// Until it ends.
  FLUXEL_PORTABLE PathEstimate follow() {
    do light();
    while (goes_on());
    return {sum_, rays_};
  }

 private:
  [[nodiscard]] FLUXEL_PORTABLE Double3 lifted(const Double3& at, const Double3& normal) const {
    return at + scene_.lift * normal;
  }

  /// The density [1/m2] with which a point of such an exitance is drawn.
  [[nodiscard]] FLUXEL_PORTABLE double density(const Double3& E) const {
    if (scene_.emitter_count == 0) return 0;
    return (std::fabs(E.x) + std::fabs(E.y) + std::fabs(E.z)) / scene_.emitter_ends[scene_.emitter_count - 1];
  }

  /// Adds what a drawn point of an emitter brings to where the path is.
  FLUXEL_PORTABLE void light() {
    if (scene_.emitter_count == 0) return;
    const ChosenPart chosen = chosen_part(scene_.emitter_ends, scene_.emitter_count, light_[0]);
    const EmittingSide& emitter = scene_.emitters[chosen.number];
    const Double3 point = surface_point(emitter.corner, emitter.corners, chosen.rest, light_[1]);
    const double kernel = kernel_between(at_, normal_, point, emitter.normal);
    if (!(kernel > 0)) return;
    ++rays_;
    // From the emitter: what single precision rounds off a receiver that is far away must not move the end
    // that lies on a surface.
    const Float3 from = narrow(lifted(point, emitter.normal));
    if (is_occluded(scene_.rays, from, narrow(lifted(at_, normal_)) - from)) return;
    sum_ = sum_ + filtered(weight_, share_of_drawn(kernel, kernel, density(emitter.E)) * emitter.E);
  }

  /// Traces the next ray and adds what it meets. Returns whether the path goes on from there.
  FLUXEL_PORTABLE bool goes_on() {
    ++rays_;
    double point[kSobolAxes];
    numbers_.next(*scene_.directions, point);
    light_[0] = point[2];
    light_[1] = point[3];
    const Ray ray{lifted(at_, normal_), cosine_direction(point[0], point[1], normal_)};
    const SideHit met = first_side(scene_.rays, scene_.flags, ray);
    if (!met.active) return false;
    const Double3 there = ray.origin + met.t * ray.direction;
    const PathSide& side = scene_.sides[2 * std::size_t{met.patch} + (met.front ? 0 : 1)];
    const double drawn = density(side.E);
    if (drawn > 0) {
      const double kernel = kernel_along(at_, normal_, ray.direction, there, met.normal);
      sum_ = sum_ + share_of_met(kernel, drawn) * filtered(weight_, side.E);
    }
    const Double3 reflected = filtered(weight_, side.rho);
    const double survival = lesser(kMaxSurvival, greater(greater(reflected.x, reflected.y), reflected.z));
    const bool survives = numbers_.next_random() < survival;
    weight_ = {reflected.x / survival, reflected.y / survival, reflected.z / survival};
    at_ = there;
    normal_ = met.normal;
    return survives;
  }

  const PathScene& scene_;
  Double3 at_, normal_;
  double light_[2];  // for the next point of an emitter
  PathNumbers numbers_;
  Double3 sum_{0, 0, 0}, weight_{1, 1, 1};
  std::uint32_t rays_ = 0;
};

}  // namespace fluxel::cuda

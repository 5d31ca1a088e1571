#include "optics/luminaire_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string_view>

#include "formfactor/even_points.hpp"
#include "optics/luminaire_emission.hpp"
#include "scene/scene.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

namespace {

/// Rays of one luminaire, and of all together where there are many.
constexpr std::size_t kRaysOfCheck = 1024, kRaysOfChecks = std::size_t{1} << 17, kLeastCheckRays = 32;

/// Part of a luminaire's flux below which nothing is said of it.
constexpr double kNotable = 0.01;

/// In largest extents of the opening: where the far field begins (the rule of five of photometry).
constexpr double kFarField = 5;

/// In largest extents of the opening, of a point in extents of the scene: what is nearer is lit in a spot so
/// small that points which are drawn over surfaces hardly find it.
constexpr double kTooNear = 0.05, kTooNearToPoint = 1e-3;

/// Segments from the middle of an opening to its rim.
constexpr int kRimPoints = 16;

/// The luminaires of which one thing is said, and the worst of them.
class Doubt {
 public:
  void add(std::string_view luminaire, std::string_view surface, double badness, double value) {
    ++count_;
    if (count_ > 1 && badness <= worst_) return;
    worst_ = badness;
    value_ = value;
    luminaire_ = luminaire;
    surface_ = surface;
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] std::string luminaire() const {
    return fmt::format("luminaire '{}'{}", luminaire_,
                       count_ == 1 ? "" : fmt::format(" (the worst of {})", count_));
  }
  [[nodiscard]] std::string_view surface() const { return surface_; }

 private:
  std::size_t count_ = 0;
  double worst_ = 0, value_ = 0;
  std::string_view luminaire_, surface_;
};

class LuminaireCheck {
 public:
  explicit LuminaireCheck(const RayScene& ray_scene)
      : ray_scene_(ray_scene),
        scene_(ray_scene.scene()),
        first_side_(ray_scene),
        lift_(static_cast<double>(ray_scene.surface_epsilon())),
        rays_(std::clamp(kRaysOfChecks / std::max<std::size_t>(1, scene_.luminaires.size()), kLeastCheckRays,
                         kRaysOfCheck)) {}

  [[nodiscard]] LuminaireDoubts doubts() {
    for (std::size_t number = 0; number < scene_.luminaires.size(); ++number) {
      const Luminaire& of = scene_.luminaires[number];
      if (!(flux(scene_.intensity(of)) > 0)) continue;
      const bool is_cut = look_for_cuts(of);
      follow_rays(number, is_cut);
    }
    LuminaireDoubts found;
    if (!cut_.empty())
      found.warnings.push_back(
          fmt::format("the opening of {} is cut by '{}', behind which part of its light starts: give another "
                      "position, aim, turn or size",
                      cut_.luminaire(), cut_.surface()));
    if (!dark_.empty())
      found.warnings.push_back(
          fmt::format("{} sends {:.3g} % of its light to dark backs, most of it to that of '{}': does it "
                      "stand inside or behind?",
                      dark_.luminaire(), 100 * dark_.value(), dark_.surface()));
    if (!lost_.empty())
      found.warnings.push_back(fmt::format(
          "{} sends {:.3g} % of its light out of the scene, which is closed: is it in the plane of a "
          "surface, or outside?",
          lost_.luminaire(), 100 * lost_.value()));
    if (!too_near_.empty())
      found.warnings.push_back(
          fmt::format("{} lights '{}' from {:.2g} m, in a spot so small that elements and pictures hardly "
                      "have it: move it "
                      "farther away",
                      too_near_.luminaire(), too_near_.surface(), too_near_.value()));
    if (!near_.empty())
      found.note = fmt::format(
          "{} lights '{}' from {:.3g} m; a photometric file is right from five times the size of the "
          "opening on",
          near_.luminaire(), near_.surface(), near_.value());
    return found;
  }

 private:
  [[nodiscard]] std::string_view surface(PatchId patch) const {
    return scene_.groups[index(scene_.patch(patch).group)];
  }

  bool look_for_cuts(const Luminaire& of) {
    const glm::dvec3 across = glm::cross(of.ahead, of.aim);
    double most = lift_;
    PatchId by = kNoPatch;
    for (int k = 0; of.size != glm::dvec2(0) && k < kRimPoints; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRimPoints;
      glm::dvec2 rim(std::cos(angle), std::sin(angle));
      if (!of.round) rim /= std::max(std::abs(rim.x), std::abs(rim.y));
      const glm::dvec3 way = 0.5 * (of.size.x * rim.x * of.ahead + of.size.y * rim.y * across);
      const PatchHit hit = ray_scene_.first_hit(of.position + lift_ * of.aim, way);
      const double beyond = (1 - hit.t) * glm::length(way);
      if (hit.patch != kNoPatch && beyond > most) most = beyond, by = hit.patch;
    }
    if (by != kNoPatch) cut_.add(of.name, surface(by), most, most);
    return by != kNoPatch;
  }

  void follow_rays(std::size_t number, bool is_cut) {
    const Luminaire& of = scene_.luminaires[number];
    const IntensityTable& table = scene_.intensity(of);
    const double size = std::max(of.size.x, of.size.y), far = kFarField * size;
    const double too_near = size > 0 ? kTooNear * size : kTooNearToPoint * scene_.extent;
    const LuminaireEmission emission(of, table);
    SobolPoints points(number);
    const double share = 1 / static_cast<double>(rays_);
    double dark = 0, near = 0, spot = 0, lost = 0, nearest = std::max(far, too_near);
    PatchId of_dark = kNoPatch, of_near = kNoPatch;
    for (std::size_t k = 0; k < rays_; ++k) {
      const EmittedRay ray = emission.ray(points.next(), lift_);
      const MetSide met = first_side_.meet(ray.from, ray.direction);
      if (met.patch == kNoPatch) {
        lost += share;
      } else if (!met.active) {
        dark += share;
        if (of_dark == kNoPatch) of_dark = met.patch;
      } else {
        if (met.t < far) near += share;
        if (met.t < too_near) spot += share;
        if (met.t < nearest) nearest = met.t, of_near = met.patch;
      }
    }
    if (dark > kNotable) dark_.add(of.name, surface(of_dark), dark, dark);
    if (lost > kNotable && scene_.statistics.closed) lost_.add(of.name, {}, lost, lost);
    if (spot > kNotable && !is_cut) too_near_.add(of.name, surface(of_near), -nearest, nearest);
    if (near > kNotable) near_.add(of.name, surface(of_near), -nearest, nearest);
  }

  const RayScene& ray_scene_;
  const Scene& scene_;
  const FirstSide first_side_;
  const double lift_;
  const std::size_t rays_;  // of each luminaire
  Doubt cut_, dark_, lost_, too_near_, near_;
};

}  // namespace

LuminaireDoubts luminaire_doubts(const RayScene& ray_scene) {
  if (ray_scene.scene().luminaires.empty()) return {};
  return LuminaireCheck(ray_scene).doubts();
}

}  // namespace fluxel

#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "optics/emitters.hpp"
#include "optics/luminaire_light.hpp"
#include "optics/luminaire_openings.hpp"
#include "reference/finished_light.hpp"
#include "reference/lit_point.hpp"
#include "sampling/owen_sobol.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

/// A path from where light falls on.
struct PathStart {
  LitPoint at;  ///< of a sight its eye alone
  /// A point of the unit square for the first point of an emitter: with the numbers that have placed the path
  /// it should be even.
  std::array<double, 2> light{};
  OwenSobol numbers;
  /// A unit direction: the path starts with a ray there, and finds not an irradiance but pi times the
  /// radiance [W/m2] of what is seen along it, also in mirrors and through what is clear, without the
  /// openings of luminaires.
  std::optional<glm::dvec3> sight = std::nullopt;
  /// What is found is the light that surfaces scatter there alone, without that of emitters and luminaires.
  /// Not of a sight, and by processors alone.
  bool is_indirect = false;
};

/// Paths of light between the patches, followed backwards from where it arrives: estimates of the diffuse
/// transport equation (Kajiya 1986) that are right on average, whatever the numbers. A vertex is lit by a
/// drawn point of an emitter and by the emitter that the path's next ray meets, weighted by the power
/// heuristic (Veach & Guibas 1995), without which light close to an emitter's edge has no finite variance;
/// paths end by Russian roulette (Arvo & Kirk 1990). Behind a mirror, a clear body or what transmits straight
/// emitters, and luminaires that have a size, are found by rays alone. Knows neither elements nor form
/// factors.
/// With the light of a finished solution at hand paths end in it where Russian roulette ends them, and where
/// that spares them bring the difference from it (a control variate: Lavenberg & Welch 1981). A quarter of
/// their first rays go to points that are drawn by what the solution reflects, the others by the cosine, each
/// weighted by the density of both (Veach & Guibas 1995): what shines brightly and looks small is found.
/// Right on average whatever the solution is. Queries may run from many threads at once.
class LightPaths {
 public:
  /// What is given must outlive this. A finished light is one between diffuse surfaces.
  explicit LightPaths(const RayScene& ray_scene, const FinishedLight* finished = nullptr);

  /// Whether anything shines, and whether any surface sends light on.
  [[nodiscard]] bool has_light() const { return !emitters_.empty() || !luminaires_.empty(); }
  [[nodiscard]] bool scatters() const;

  /// Estimates of the irradiance [W/m2] where each path starts. Many paths are traced at once, bounce by
  /// bounce, their rays in packets: the same values as of each path alone, but for what RayScene::first_hits
  /// says.
  void irradiance(std::span<const PathStart> starts, std::span<Rgb> found, std::uint64_t& rays) const;

  /// A point that is seen.
  struct Seen {
    LitPoint at;
    const SideLight* side = nullptr;  ///< see leaving_side; null: nothing is seen
    PatchId patch = kNoPatch;
    bool front = true;

    /// Whether it brings light.
    [[nodiscard]] bool is_active() const { return side != nullptr && side->active; }
  };
  /// What each of many rays meets first.
  void first_seen(std::span<const Ray> rays, std::span<Seen> seen) const;

 private:
  class Wave;
  /// The light that a point of an emitter brings if nothing stands in between.
  struct Lit {
    glm::dvec3 from{0};  ///< lifted off the emitter
    Rgb light{0};        ///< irradiance times weight [W/m2]
  };
  /// Where a path's next ray goes.
  struct Heading {
    glm::dvec3 direction{0};
    std::optional<DrawnPoint> drawn;  ///< to where, if to a point that was drawn
  };
  struct Next {
    double kernel = 0;   ///< cos cos / (pi r^2) [1/m2]
    double density = 0;  ///< of the point, as it was drawn [1/m2]
  };
  [[nodiscard]] double density_of_next(double kernel, const DrawnPoint& point, bool is_guided) const;
  [[nodiscard]] std::optional<Lit> lit_by(const LitPoint& at, std::array<double, 2> light,
                                          bool is_guided) const;
  [[nodiscard]] std::optional<Heading> heading(const LitPoint& at, double u, double v, bool is_guided) const;
  /// Of what the ray has met; none: the path ends.
  [[nodiscard]] std::optional<Next> next(const LitPoint& at, const Heading& to, const Seen& met,
                                         bool is_guided) const;
  [[nodiscard]] glm::dvec3 lifted(const LitPoint& at) const;

  const RayScene& ray_scene_;
  FirstSide first_side_;
  const FinishedLight* finished_;  ///< null: there is none
  bool guides_;
  Emitters emitters_;
  LuminaireLight luminaires_;
  LuminaireOpenings openings_;
  std::vector<std::array<SideLight, 2>> sides_;  ///< leaving the front and the back of each patch
};

}  // namespace fluxel

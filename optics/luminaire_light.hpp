#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "optics/luminaire_emission.hpp"
#include "optics/luminaire_tree.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// What a point of a luminaire's opening brings if nothing stands in between.
struct LuminaireRay {
  glm::dvec3 from{0};    ///< on the opening [m]
  glm::dvec3 normal{0};  ///< unit, of the opening, to where the ray leaves it
  Rgb light{0};          ///< irradiance; of a drawn ray over the density of the draw [W/m2]
  /// Of a luminaire close to a surface: nearer than this its light falls in a spot that paths hardly find,
  /// and that rays from the luminaire do [m]; else 0.
  double reach = 0;
};

/// A ray that leaves a luminaire close to a surface.
struct SpotRay {
  EmittedRay ray;
  Rgb power{0};      ///< of its luminaire, over the chance of the draw [W]
  double reach = 0;  ///< see LuminaireRay
};

/// The light of a scene's luminaires straight to points of surfaces: I(C, gamma) cos / r^2 of each point of
/// an opening, over all of which the luminaire's intensity is spread evenly. Queries may run from many
/// threads at once.
class LuminaireLight {
 public:
  /// The ray scene, and its scene, must outlive this.
  explicit LuminaireLight(const RayScene& ray_scene);

  [[nodiscard]] bool empty() const { return emitters_.empty(); }
  [[nodiscard]] std::size_t size() const { return emitters_.size(); }  ///< of those that shine
  [[nodiscard]] const Rgb& flux() const { return flux_; }              ///< of all [W] or [lm]

  /// From a place to the nearest opening [m].
  [[nodiscard]] double distance(const glm::dvec3& at) const;

  /// A ray that is drawn by three numbers of [0, 1): of a group of luminaires that the tree of them draws, by
  /// about what each brings there, and of its opening evenly. Without light: nothing comes that way.
  [[nodiscard]] LuminaireRay draw(const LitPlace& at, double choice, double u, double v) const;

  /// Whether some are close to surfaces. Of more than 64 luminaires none is taken as such.
  [[nodiscard]] bool makes_spots() const { return !spots_.empty(); }
  /// One of these by five numbers of [0, 1), by its power, and a ray of it.
  [[nodiscard]] SpotRay draw_to_spot(double choice, const std::array<double, 4>& numbers) const;

  /// The mean of `draws` rays that are drawn of all luminaires by about what each brings there, or where
  /// there are no more luminaires the sum over all, with as many rays in all from lattices over their
  /// openings, and more of openings that are near; by the numbers of a seed, which are the same for any
  /// place. Seed 0: lattices lie in the middle, so that openings send from where they are; else they do on
  /// average. Adds the rays to `traced`.
  [[nodiscard]] Rgb sampled_irradiance(const LitPlace& at, std::size_t draws, std::uint64_t seed,
                                       std::uint64_t& traced) const;

  /// The irradiance by two halves of the rays, each by numbers of its own; of luminaires that are points both
  /// are exact, and the same. As many rays as PointGather takes: what the first ones of each half vary by
  /// tells how many the other gets, `rays_a_spread` for a standard deviation of 1 W/m2. Adds the rays to
  /// `traced`.
  [[nodiscard]] std::array<Rgb, 2> irradiance_halves(const LitPlace& at, double rays_a_spread,
                                                     std::uint64_t seed, std::uint64_t& traced) const;

 private:
  /// A luminaire, and what is asked of it at every point.
  struct Emitter {
    const Luminaire* luminaire;
    const IntensityTable* table;
    glm::dvec3 across;  ///< unit: C = 90 degrees
    double reach;       ///< half of the opening's diagonal [m]; 0 of a point
    double mean;        ///< of the intensity over all directions and colours
    double most;        ///< of the intensity, likewise of the colours
    double spot;        ///< see LuminaireRay::reach
  };
  /// A luminaire close to a surface.
  struct Spot {
    LuminaireEmission emission;
    Rgb power;
    double reach;
    double end;  ///< running sum of the powers, mean of the colours
  };
  /// Luminaires that are drawn from together, by what each is expected to bring to a place.
  struct Draw {
    std::vector<std::uint32_t> numbers;
    std::vector<double> ends;  ///< running sums of what is expected
  };

  [[nodiscard]] LuminaireRay ray_of(const Emitter& emitter, const LitPlace& at, double u, double v) const;
  [[nodiscard]] static double distance(const Emitter& emitter, const glm::dvec3& at);
  [[nodiscard]] static double geometric_factor(const Emitter& emitter, const LitPlace& at);
  [[nodiscard]] double expected(const Emitter& emitter, const LitPlace& at, double geometric_factor) const;
  [[nodiscard]] double expected(const Emitter& emitter, const LitPlace& at) const;
  void add_rays(const Emitter& emitter, const LitPlace& at, std::size_t least, const glm::dvec2& shift,
                std::vector<LuminaireRay>& rays) const;
  [[nodiscard]] LuminaireRay drawn(const Draw& draw, const LitPlace& at, double choice, double u,
                                   double v) const;
  [[nodiscard]] Draw all_at(const LitPlace& at) const;
  [[nodiscard]] static LuminaireTree tree_of(std::span<const Emitter> emitters);

  static std::vector<Emitter> emitters_of(const Scene& scene);
  void find_spots();

  const RayScene& ray_scene_;
  std::vector<Emitter> emitters_;
  const LuminaireTree tree_;
  std::vector<Spot> spots_;
  Rgb flux_{0};
};

}  // namespace fluxel

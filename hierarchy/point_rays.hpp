#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "hierarchy/emitter_view.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/ray_light.hpp"

namespace fluxel {

/// What a solution has where a ray ends.
struct EndLight {
  Rgb reflected{0};     ///< radiosity without emission [W/m2]
  double variance = 0;  ///< SecondMoments::trace of the part of the surface that has it [m2]
};

/// The light of a finished solution at points of leaves of a tree, from any number of threads.
class SolutionLight {
 public:
  virtual ~SolutionLight() = default;
  [[nodiscard]] virtual EndLight at(NodeId leaf, const glm::dvec3& point) const = 0;
};

/// What rays may meet, and what of it is asked for.
struct MetLight {
  const RayLight& emitted;
  const SolutionLight& solution;
  Rgb scale;  ///< of what is reflected
  LightFrom from = LightFrom::everywhere;

  [[nodiscard]] bool asks_hemisphere() const { return from != LightFrom::emission; }
  [[nodiscard]] bool asks_lamps() const {
    return from != LightFrom::reflection && !emitted.emitters().empty();
  }
  [[nodiscard]] bool asks_luminaires() const {
    return from != LightFrom::reflection && !emitted.luminaires().empty();
  }
  [[nodiscard]] RayNumbers numbers() const { return asks_hemisphere() ? kBoth : RayNumbers{0, 1}; }

  /// The weights of the two kinds of rays that may meet an emitter, whatever their numbers.
  static constexpr RayNumbers kBoth{4, 1};
};

/// The irradiance of a point by two halves of its rays. What the first ones of each half vary by tells how
/// many the other gets: the more the brighter and the less even its surroundings are (Neyman 1934), and right
/// in the mean, which a number that depends on the very rays that it is of would not be. So a point's rays
/// are asked for twice, and traced each time: by the processor, or elsewhere.
class PointGather {
 public:
  /// What is given must outlive this. `rays_a_spread`: for a spread of 1 W/m2.
  PointGather(const MetLight& light, const ReceivingPoint& at, double rays_a_spread, std::uint64_t seed);
  ~PointGather();

  void ask_pilots();
  void ask_rest();

  /// Traces what was asked for.
  void trace();

  /// Rays of the hemisphere that were asked for; what they meet first may be found elsewhere. `take` traces
  /// all other rays.
  [[nodiscard]] std::size_t asked() const;
  void aim(std::span<Ray> rays);
  void take(std::span<const Ray> rays, std::span<const PatchHit> hits);

  /// By each half of the rays [W/m2].
  [[nodiscard]] std::array<Rgb, 2> irradiance() const;
  [[nodiscard]] std::uint64_t rays() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel

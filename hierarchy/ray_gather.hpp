#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "core/ranks.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/point_rays.hpp"
#include "hierarchy/verified_hits.hpp"

namespace fluxel {

/// Who gathers, and what all ranks are to call between parts of the work.
struct GatherCrew {
  const Ranks& ranks;
  int threads = 1;
  std::function<bool()> is_stopped;  ///< of this rank: what is left of a part may be left out
  std::function<void()> between;     ///< collective
};

/// The irradiance of points by rays over their hemispheres and to emitters, as many as the goal's error
/// takes, two halves of them each on its own. Where they end on parts of surfaces that are close by, one ray
/// goes on, over at most four bounces: the radiosity there may be far from that of such a part.
class RayGather {
 public:
  /// All must outlive this; what is reflected at the ends of rays is multiplied by `scale`. `device`: finds
  /// what the rays of hemispheres meet first, but where one goes on; null: the processor does.
  RayGather(const RayLight& emitted, const SolutionLight& solution, const Rgb& scale,
            VerifiedHits* device = nullptr)
      : emitted_(emitted), solution_(solution), scale_(scale), device_(device) {}

  /// Collective; see IrradianceSource::gather_halves.
  [[nodiscard]] std::array<std::vector<Rgb>, 2> gather(std::span<const GatherPoint> points,
                                                       const GatherGoal& goal, const GatherCrew& crew,
                                                       Progress& progress);
  [[nodiscard]] std::uint64_t rays() const { return rays_; }  ///< of this rank, by all gathers

 private:
  const RayLight& emitted_;
  const SolutionLight& solution_;
  Rgb scale_;
  VerifiedHits* device_;
  std::uint64_t rays_ = 0;
};

/// Half of the sum of both, entry by entry.
[[nodiscard]] std::vector<Rgb> mean_of_halves(const std::array<std::vector<Rgb>, 2>& halves);

}  // namespace fluxel

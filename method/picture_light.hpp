#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "final_gather/irradiance_filter.hpp"
#include "hierarchy/irradiance_source.hpp"
#include "method/error_control.hpp"
#include "method/problem.hpp"

namespace fluxel {

/// A phase of the run.
inline constexpr const char* kGatheringPicture = "gathering the picture";

/// What is asked of a picture.
struct PictureGoal {
  std::span<const std::uint32_t> probes;  ///< pixels that something is known of
  const ProbedLight& probed;
  double ray_error = 0;  ///< see GatherGoal, of pixels that are gathered each on its own
  double allowed = 0;  ///< error of the picture, by how its light is gathered: root mean square over the mean
  bool has_time = true;  ///< to gather every pixel where records do not come to that
};

struct PictureLight {
  std::vector<Rgb> irradiance;  ///< of each pixel [W/m2]
  /// As PictureGoal::allowed, by what records, rays and the probes say; none: it is what the rays were chosen
  /// for.
  std::optional<double> error;
  std::size_t records = 0;  ///< see SparseLight; 0: every pixel was gathered
  std::size_t single = 0;   ///< likewise
  double ray_error = 0;     ///< see PictureGoal: that of the last try
};

/// Collective: noise is taken out of halves of the pixels' irradiance.
[[nodiscard]] IrradianceHalves filter_pixels(const Problem& problem, const IrradianceFilter& filter,
                                             const IrradianceHalves& halves);

/// What the filter looks at of the points' faces.
[[nodiscard]] std::vector<SeenSurface> surfaces_of(const NodeTree& tree, std::span<const GatherPoint> points);

/// What halves that are filtered differ by is less than their error, as each lies between its neighbours: by
/// so much. By comparing pictures of stairs and a hall, where it was 1.0 to 1.23 times as much.
inline constexpr double kHiddenByFilter = 1.2;

/// The error of the mean of filtered halves by what they differ by, root mean square over `mean` [W/m2].
[[nodiscard]] double error_by_halves(const NodeTree& tree, std::span<const GatherPoint> points,
                                     const IrradianceHalves& halves, const Rgb& mean);

/// Collective: the irradiance of a picture's pixels: of light from emitters at each of them, of what is
/// reflected by records at few (see gather_sparsely), or where these do not come to what is allowed as
/// gather_each has it. `points` are those of the pixels, of whole rows of `width`.
[[nodiscard]] PictureLight gather_cached(const Problem& problem, IrradianceSource& source, int width,
                                         std::span<const GatherPoint> points, const PictureGoal& goal);

/// Collective: the irradiance of a picture's pixels, each gathered: by links, of the error that it may have;
/// by few rays, with noise filtered out, and by more of them until it is as close to what is known of the
/// probes as is allowed, or each pixel has as many rays as it needs on its own to be said to be so.
[[nodiscard]] PictureLight gather_each(const Problem& problem, IrradianceSource& source, int width,
                                       std::span<const GatherPoint> points, const PictureGoal& goal);

}  // namespace fluxel

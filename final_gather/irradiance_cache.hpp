#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "final_gather/side_point.hpp"
#include "octree/sphere_octree.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// The irradiance that has been gathered at a place.
struct IrradianceRecord {
  SidePoint at;
  Rgb irradiance{0};    ///< [W/m2]
  double variance = 0;  ///< of its noise, of the mean of the colours, right on average [W2/m4]
};

/// Records that reach a place where they lie evenly.
inline constexpr std::size_t kReaching = 10;

/// From one to the next there, where each reaches so far.
[[nodiscard]] inline double spacing_of(double reach) {
  return reach * std::sqrt(std::numbers::pi / static_cast<double>(kReaching));
}

/// What records tell of a place, as a sum over some of them with weights that sum to about 1.
struct Interpolated {
  Rgb irradiance{0};  ///< [W/m2]
  double noise = 0;   ///< variance of what the records' noise leaves, of the mean of the colours [W2/m4]
  double record_noise = 0;  ///< variance of one record, likewise, mean of those that count [W2/m4]
  double stretch = 0;       ///< sum of their sizes times the squared distances [m2]
  double reach = 0;         ///< mean of the records' [m]
  double bend = 0;          ///< what records nearby are off by, over their stretch [W/m4]
  int records = 0;          ///< none: nothing is known of the place

  /// The error that is to be expected beside noise, mean of the colours [W/m2].
  [[nodiscard]] double bias() const { return bend * stretch; }
};

/// Irradiance that varies smoothly, from records of it: at each place a linear function of position and
/// normal that fits best to the records around, the nearer ones more (locally weighted regression: Cleveland
/// & Devlin 1988; irradiance caches: Ward, Rubinstein & Clear 1988, whose records have gradients of their
/// own). A record counts on the side of a surface that bends away from its plane by a little, and where
/// nothing stands between. How wrong that is each record tells, against what the others say of its place.
class IrradianceCache {
 public:
  /// The ray scene must outlive this.
  IrradianceCache(const RayScene& ray_scene, std::vector<IrradianceRecord> records, int threads);

  [[nodiscard]] Interpolated at(const SidePoint& point) const { return interpolate(point, kNone); }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  [[nodiscard]] Interpolated interpolate(const SidePoint& point, std::uint32_t left_out) const;
  void find_radii(int threads);
  void look_at_each(int threads);

  const RayScene& ray_scene_;
  std::vector<IrradianceRecord> records_;
  std::vector<float> radii_;  // of each record: it tells nothing beyond [m]
  std::vector<double> bend_;  // of each record, squared, less what noise is expected to make of it
  std::optional<SphereOctree> places_;
};

}  // namespace fluxel

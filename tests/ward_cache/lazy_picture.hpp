#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "tests/ward_cache/gathered_room.hpp"
#include "tests/ward_cache/ward_cache.hpp"

namespace fluxel::ward_cache {

/// How a lazy cache makes a picture.
struct LazySettings {
  double acceptance = 0.2;         ///< see WardCache
  double least_pixels = 1;         ///< that a record reaches at least
  bool limits_by_gradient = true;  ///< R at most where the gradient would make the irradiance 0
};

struct LazyPicture {
  std::vector<Rgb> irradiance;  ///< of each pixel [W/m2]
  std::size_t records = 0;
};

/// Makes pictures of one room, each with a cache of its own. What a place sees around it is looked at once.
class LazyPainter {
 public:
  explicit LazyPainter(const GatheredRoom& room, const Strata& strata = {}) : room_(room), strata_(strata) {}

  /// Records where none reach, over grids of pixels of which each is twice as fine as the one before (Ward,
  /// Rubinstein & Clear 1988); then all pixels from all records.
  [[nodiscard]] LazyPicture paint(const LazySettings& settings);

 private:
  [[nodiscard]] WardRecord record(std::uint32_t pixel, const LazySettings& settings);

  const GatheredRoom& room_;
  Strata strata_;
  std::map<std::uint32_t, HemisphereLight> around_;  // pixels' places
};

}  // namespace fluxel::ward_cache

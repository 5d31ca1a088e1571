#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tests/ward_cache/lazy_picture.hpp"

namespace fluxel::ward_cache {

/// What a number of records came to.
struct RecordCount {
  double records = 0;
  double error = 0;  ///< see GatheredRoom::error_of
};

/// Of lazy caches of these acceptances.
[[nodiscard]] std::vector<RecordCount> count_lazily(const GatheredRoom& room, LazyPainter& painter,
                                                    std::span<const double> acceptances,
                                                    LazySettings settings);

/// Of gather_sparsely, pixels that are gathered each on its own included.
[[nodiscard]] RecordCount count_sparsely(GatheredRoom& room, double allowed);

/// Records that an error takes: the fewest by which any two neighbours of a series, one above and one below
/// it, come to it in a straight line between logarithms. None where no two do.
[[nodiscard]] std::optional<double> records_at(double error, std::span<const RecordCount> series);

}  // namespace fluxel::ward_cache

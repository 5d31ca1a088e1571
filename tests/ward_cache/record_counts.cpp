#include "tests/ward_cache/record_counts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/options.hpp"

namespace fluxel::ward_cache {

std::vector<RecordCount> count_lazily(const GatheredRoom& room, LazyPainter& painter,
                                      std::span<const double> acceptances, LazySettings settings) {
  std::vector<RecordCount> counts;
  for (const double acceptance : acceptances) {
    settings.acceptance = acceptance;
    const LazyPicture picture = painter.paint(settings);
    counts.push_back({static_cast<double>(picture.records), room.error_of(picture.irradiance)});
  }
  return counts;
}

RecordCount count_sparsely(GatheredRoom& room, double allowed) {
  const SparseLight light = room.gather_sparsely(allowed);
  return {static_cast<double>(light.records + light.single), room.error_of(light.irradiance)};
}

std::optional<double> records_at(double error, std::span<const RecordCount> series) {
  double fewest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < series.size(); ++k) {
    const RecordCount &a = series[k], &b = series[k + 1];
    if ((a.error - error) * (b.error - error) > 0 || a.error == b.error) continue;
    const double part = std::log(error / a.error) / std::log(b.error / a.error);
    fewest = std::min(fewest, a.records * std::pow(b.records / a.records, part));
  }
  return std::isinf(fewest) ? std::nullopt : std::optional(fewest);
}

}  // namespace fluxel::ward_cache

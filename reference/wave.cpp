#include "reference/wave.hpp"

#include <vector>

#include "core/sampling.hpp"
#include "reference/path_batch.hpp"

namespace fluxel {

std::uint64_t measure_wave(const Sensors& sensors, const Wave& wave, std::size_t from, std::span<Rgb> means) {
  const std::uint64_t seed = random_bits(wave.seed);
  PathBatch batch(sensors);
  std::vector<PathSum> sums(means.size());
  for (std::size_t k = 0; k < means.size(); ++k) {
    const auto first = static_cast<std::uint32_t>((from + k) * wave.paths);
    for (std::uint32_t path = 0; path < wave.paths; ++path)
      batch.add({from + k, OwenSobol(seed, first + path)}, sums[k]);
  }
  batch.trace();
  for (std::size_t k = 0; k < means.size(); ++k) means[k] = sums[k].sum / static_cast<double>(wave.paths);
  return batch.rays();
}

}  // namespace fluxel

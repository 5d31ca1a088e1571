#include "reference/wave.hpp"

#include "core/sampling.hpp"
#include "reference/path_batch.hpp"

namespace fluxel {

std::uint64_t measure_wave(const Sensors& sensors, const Wave& wave, std::size_t from, std::span<Rgb> means) {
  const std::uint64_t seed = random_bits(wave.seed);
  PathBatch batch(sensors);
  for (std::size_t k = 0; k < means.size(); ++k) {
    const auto first = static_cast<std::uint32_t>((from + k) * wave.paths);
    means[k] = Rgb(0);
    for (std::uint32_t path = 0; path < wave.paths; ++path)
      batch.add({from + k, OwenSobol(seed, first + path)}, means[k]);
  }
  batch.trace();
  for (Rgb& mean : means) mean /= wave.paths;
  return batch.rays();
}

}  // namespace fluxel

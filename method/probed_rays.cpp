#include "method/probed_rays.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "method/relative_error.hpp"

namespace fluxel {

namespace {

/// Of what the noise of rays may be: what is aimed at. By links little of the light is noisy, and what there
/// is of it comes on top of what is between records, so that a finer aim saves second tries.
constexpr double kShareOfNoise = 0.95, kShareByLinks = 0.8;

/// How far beside the first guess the rays may be, which few probes tell; how often links are probed.
constexpr double kFarOff = 4;
constexpr int kMostProbings = 6;

/// What rays of this error say of the probes' light.
ProbedLight probe(IrradianceSource& source, std::span<const GatherPoint> probes, double ray_error) {
  SilentProgress silent;
  const auto halves = source.gather_halves(probes, {ray_error, source.mean_radiosity()}, silent);
  std::vector<Rgb> other;
  ProbedLight probed;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const Rgb& rho = source.tree().material(probes[k].face).rho;
    other.push_back(rho * (halves[1][k] - halves[0][k]) / 2.0);
    probed.B.push_back(rho * (halves[0][k] + halves[1][k]) / 2.0);
    probed.noise += other.back() * other.back() / static_cast<double>(probes.size());
    probed.mean += probed.B.back() / static_cast<double>(probes.size());
  }
  return probed;
}

}  // namespace

// Noise by rays falls as their number grows. By links it lies where few rays see whether a link is partly
// hidden, and what more of them would leave is known by probing again alone.
ProbedRays probe_for(IrradianceSource& source, std::span<const GatherPoint> probes, double allowed) {
  const double wanted = (source.by_rays() ? kShareOfNoise : kShareByLinks) * allowed;
  ProbedRays probing{{}, allowed};
  for (int probings = 1;; ++probings) {
    probing.light = probe(source, probes, probing.ray_error);
    if (!(mean_of_colours(probing.light.mean) > 0)) return probing;
    probing.noise = root_over_mean(probing.light.noise, probing.light.mean);
    const bool is_enough = !source.by_rays() && (probing.noise <= wanted || probings == kMostProbings);
    if (is_enough) return probing;
    const double times =
        std::clamp(probing.noise > 0 ? wanted / probing.noise : kFarOff, 1 / kFarOff, kFarOff);
    probing.ray_error *= times;
    if (source.by_rays()) {
      probing.noise *= times;
      return probing;
    }
  }
}

}  // namespace fluxel

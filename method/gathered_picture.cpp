#include "method/gathered_picture.hpp"

#include <algorithm>
#include <utility>

#include "method/probes.hpp"
#include "method/relative_error.hpp"
#include "method/smooth_edges.hpp"

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

/// What is known of the probes, and the rays that the picture gets.
struct Probing {
  ProbedLight light;
  double ray_error = 0;
  double noise = 0;  ///< of these rays, root mean square over the mean
};

/// Noise by rays falls as their number grows. By links it lies where few rays see whether a link is partly
/// hidden, and what more of them would leave is known by probing again alone.
Probing probe_for(IrradianceSource& source, std::span<const GatherPoint> probes, double allowed) {
  const double wanted = (source.by_rays() ? kShareOfNoise : kShareByLinks) * allowed;
  Probing probing{{}, allowed};
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

}  // namespace

bool gathers_picture(const Options& options) {
  // Elements that the camera has made are as fine as its pixels.
  return options.camera && options.subdivision != Subdivision::camera &&
         options.picture != PictureFrom::elements;
}

void take_picture(PictureLight light, Solution& solution) {
  solution.pixel_irradiance = std::move(light.irradiance);
  solution.picture = PictureStatistics{light.records, light.single, light.error, light.ray_error};
}

void gather_picture(const Problem& problem, IrradianceSource& source, double allowed, Solution& solution) {
  const Options& options = problem.options;
  const Raster& raster = solution.subdivided.raster;
  const std::vector<GatherPoint> points =
      seen_points_of(source.tree(), *options.camera, options.supersample, raster);
  const std::vector<std::uint32_t> pixels = choose_probes(source.tree(), points);
  std::vector<GatherPoint> probes;
  probes.reserve(pixels.size());
  for (const std::uint32_t pixel : pixels) probes.push_back(points[pixel]);
  const Probing probing = probe_for(source, probes, allowed);
  // Of what is dark nothing is relative to its mean.
  if (!(mean_of_colours(probing.light.mean) > 0)) {
    problem.progress.begin(kGatheringPicture);
    take_picture(
        {source.gather(points, {allowed, source.mean_radiosity()}, problem.progress), {}, 0, 0, allowed},
        solution);
    problem.progress.end();
    smooth_gathered_edges(problem, source, solution);
    return;
  }
  PictureLight light = (options.picture == PictureFrom::cached ? gather_cached : gather_each)(
      problem, source, raster.width, points, {pixels, probing.light, probing.ray_error, allowed});
  // Pixels that were gathered each by links have what the probes have.
  if (!light.error) light.error = probing.noise;
  take_picture(std::move(light), solution);
  smooth_gathered_edges(problem, source, solution);
}

}  // namespace fluxel

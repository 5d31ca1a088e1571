#include "method/gathered_picture.hpp"

#include <utility>

#include "core/options.hpp"
#include "method/probed_rays.hpp"
#include "method/probes.hpp"
#include "method/smooth_edges.hpp"

namespace fluxel {

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
  const ProbedRays probing = probe_for(source, probes, allowed);
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

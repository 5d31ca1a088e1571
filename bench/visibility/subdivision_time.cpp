#include "bench/visibility/subdivision_time.hpp"

#include "bench/visibility/stopwatch.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/subdivide.hpp"

namespace fluxel::bench {

SubdivisionTime time_subdivision(const Scene& scene, Camera camera, int resolution, int repetitions) {
  constexpr int kSupersample = 1, kThreads = 1;
  camera.width = camera.height = resolution;
  SubdivisionTime result;
  std::vector<double> raster_seconds, split_seconds;
  for (int k = 0; k < repetitions; ++k) {
    Raster raster;
    raster_seconds.push_back(seconds_of([&] {
      const RayScene ray_scene(scene, kThreads);
      const std::vector<double> nearest = nearest_depths(ray_scene, scene, camera, kSupersample, kThreads);
      const auto claims = claim_pixels(ray_scene, scene, camera, kSupersample, nearest, kThreads);
      raster = make_raster(scene, camera, kSupersample, claims);
    }));
    split_seconds.push_back(seconds_of([&] {
      const std::vector<SeenPoint> seen = seen_points(scene, camera, kSupersample, raster);
      const SplitCriterion criterion{1, default_max_edge(scene, seen.size())};
      result.elements = subdivide_pieces(scene, 0, scene.pieces.size(), seen, criterion).mesh.elements.size();
    }));
  }
  result.raster_seconds = median(raster_seconds);
  result.split_seconds = median(split_seconds);
  return result;
}

}  // namespace fluxel::bench

#include "output/pictures.hpp"

#include <numbers>

#include "core/options.hpp"
#include "image/median_filter.hpp"
#include "image/png_writer.hpp"

namespace fluxel {

SurfaceLight split_sides(std::span<const Rgb> B, std::span<const Rgb> H, std::size_t elements) {
  const auto middle = static_cast<std::ptrdiff_t>(elements);
  return {{B.begin(), B.begin() + middle},
          {B.begin() + middle, B.end()},
          {H.begin(), H.begin() + middle},
          {H.begin() + middle, H.end()}};
}

RunPicture make_run_picture(const RunRecord& record) {
  const Solution& solution = record.solution;
  const SubdividedScene& subdivided = solution.subdivided;
  RunPicture made;
  made.picture =
      make_picture(subdivided.raster, record.options.supersample, record.scene, subdivided.mesh,
                   split_sides(solution.radiosity->B, solution.radiosity->H, subdivided.mesh.elements.size()),
                   solution.pixel_irradiance, solution.edges);
  apply_median(record.options.median_radius, made.picture);
  made.display = tone_map(made.picture, record.options.exposure, record.options.tone);
  return made;
}

void write_early_picture(const std::filesystem::path& file, const Options& options, const Scene& scene,
                         const SubdividedScene& subdivided, std::span<const Rgb> B) {
  // The picture's layer of irradiance is not shown.
  const SurfaceLight light = split_sides(B, B, subdivided.mesh.elements.size());
  Picture picture = make_picture(subdivided.raster, options.supersample, scene, subdivided.mesh, light);
  apply_median(options.median_radius, picture);
  write_png(file, tone_map(picture, options.exposure, options.tone));
}

void write_early_picture(const std::filesystem::path& file, const Options& options,
                         const EarlyPicture& early) {
  Picture picture;
  picture.width = early.width;
  picture.height = early.height;
  picture.reflectance = early.reflectance;
  picture.irradiance = early.irradiance;
  for (std::size_t k = 0; k < picture.pixels(); ++k)
    picture.radiance.push_back((early.exitance[k] + early.reflectance[k] * early.irradiance[k]) /
                               std::numbers::pi);
  write_png(file, tone_map(picture, options.exposure, options.tone));
}

}  // namespace fluxel

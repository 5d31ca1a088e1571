#include "app/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/command_line.hpp"
#include "app/version_text.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/surface_light.hpp"
#include "image/exr_writer.hpp"
#include "image/filter.hpp"
#include "image/picture.hpp"
#include "image/png_writer.hpp"
#include "image/tone_map.hpp"
#include "scene/solution_writer.hpp"

namespace fluxel {

namespace {

SurfaceLight split_sides(std::span<const Rgb> B, std::span<const Rgb> H, std::size_t elements) {
  const auto middle = static_cast<std::ptrdiff_t>(elements);
  return {{B.begin(), B.begin() + middle},
          {B.begin() + middle, B.end()},
          {H.begin(), H.begin() + middle},
          {H.begin() + middle, H.end()}};
}

bool fits_single_precision(const std::vector<Rgb>& values) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return std::ranges::all_of(values, [](const Rgb& value) {
    return std::abs(value.r) <= kLargest && std::abs(value.g) <= kLargest && std::abs(value.b) <= kLargest;
  });
}

std::map<std::string, std::string> attributes(const RunReport& report) {
  std::map<std::string, std::string> text;
  for (const auto& [name, value] : describe(report.options)) text["fluxel." + name] = value;
  text["fluxel.version"] = version_text();
  text["fluxel.ranks"] = fmt::format("{}", report.places.size());
  text["fluxel.elements"] = fmt::format("{}", report.elements);
  text["fluxel.iterations"] = fmt::format("{}", report.radiosity->iterations);
  text["fluxel.error_bound"] = fmt::format("{:.3g}", report.radiosity->error_bound);
  text["fluxel.converged"] = report.radiosity->converged ? "true" : "false";
  text["fluxel.seconds"] =
      fmt::format("load {:.3f}, subdivision {:.3f}, visibility {:.3f}, solve {:.3f}", report.time.load.wall,
                  report.time.subdivision.wall, report.time.visibility.wall, report.time.solve.wall);
  return text;
}

void write_pictures(const Scene& scene, const SubdividedScene& subdivided, const SurfaceLight& light,
                    std::span<const Rgb> irradiance, RunReport& report) {
  const std::filesystem::path folder = report.options.out;
  Picture picture =
      make_picture(subdivided.raster, report.options.supersample, scene, subdivided.mesh, light, irradiance);
  apply_filter(report.options.filter, picture);
  const DisplayPicture display = tone_map(picture, report.options.exposure);
  report.exposure = display.exposure;
  write_exr(folder / "image.exr", picture, attributes(report));
  write_png(folder / "image.png", display);
}

/// What a checkpoint's folder may hold of an earlier run's strips and rounds.
std::vector<std::filesystem::path> kept_files(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed))
    if (at->path().extension() == ".fxs" || at->path().extension() == ".fxr") files.push_back(at->path());
  return files;
}

/// Whether a run with these options writes the file.
bool is_wanted(const std::filesystem::path& name, const Options& options) {
  if (name == "solution.ply") return true;
  if (name == "thermal.csv") return options.thermal;
  if (std::ranges::find(kPreviews, name) != kPreviews.end()) return options.preview;
  return options.camera.has_value();
}

}  // namespace

void require_outputs(const Options& options, std::span<const std::filesystem::path> inputs) {
  const std::filesystem::path folder = options.out;
  std::vector<std::filesystem::path> outputs = kept_files(options.checkpoint);
  for (const char* name : kOutputs) outputs.push_back(folder / name);
  require_inputs_kept(inputs, outputs);
  require_writable_folder(folder);
  for (const char* name : kOutputs)
    if (std::filesystem::is_directory(folder / name))
      throw input_error_at(folder / name, 0, "is a folder where a file will be written",
                           "remove it, or choose another --out");
}

std::vector<std::filesystem::path> stale_outputs(const Options& options, bool written) {
  const std::filesystem::path folder = options.out;
  std::vector<std::filesystem::path> stale;
  for (const std::filesystem::path name : kOutputs) {
    if (name == "report.json" || (written && is_wanted(name, options))) continue;
    if (name == "convergence.csv" && !options.dry_run) continue;
    if (name == "timeline.csv" && options.timeline && !options.dry_run) continue;
    if (std::filesystem::exists(folder / name)) stale.push_back(folder / name);
  }
  return stale;
}

void remove_outputs(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    std::error_code failed;
    std::filesystem::remove(file, failed);
    if (failed) throw input_error_at(file, 0, "an earlier run's file cannot be removed: " + failed.message());
  }
}

void write_preview(const std::filesystem::path& file, const Scene& scene, const SubdividedScene& subdivided,
                   std::span<const Rgb> B, const RunReport& report) {
  // The picture's layer of irradiance is not shown.
  const SurfaceLight light = split_sides(B, B, subdivided.mesh.elements.size());
  const Options& options = report.options;
  Picture picture = make_picture(subdivided.raster, options.supersample, scene, subdivided.mesh, light);
  apply_filter(options.filter, picture);
  write_png(file, tone_map(picture, options.exposure));
}

bool write_outputs(const Scene& scene, const SubdividedScene& subdivided, std::span<const Rgb> irradiance,
                   RunReport& report) {
  const Radiosity& radiosity = *report.radiosity;
  if (!fits_single_precision(radiosity.B) || !fits_single_precision(radiosity.H)) return false;
  const SurfaceLight light = split_sides(radiosity.B, radiosity.H, subdivided.mesh.elements.size());
  const std::filesystem::path folder = report.options.out;
  if (report.options.camera) write_pictures(scene, subdivided, light, irradiance, report);
  write_solution(folder / "solution.ply", scene, subdivided.mesh, light);
  if (report.options.thermal) write_thermal(folder / "thermal.csv", report.thermal);
  return true;
}

}  // namespace fluxel

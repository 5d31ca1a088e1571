#include "output/reference_files.hpp"

#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

#include "core/file.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "image/tone_map.hpp"
#include "output/json_parts.hpp"
#include "output/receiver_files.hpp"
#include "output/version_text.hpp"

namespace fluxel {

namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> attributes(const ReferenceOptions& options) {
  return {{"fluxel.version", version_text()},
          {"fluxel.scene", options.run.scene},
          {"fluxel.seed", fmt::format("{}", options.seed)}};
}

/// Of fronts, then of backs where there are any; each layer by the names that compare knows.
void write_elements(const fs::path& file, const FileElements& elements, const SensorLight& light) {
  const std::vector<SensorEstimate>& sensors = light.measured.sensors;
  const std::size_t count = elements.outlines.size();
  std::map<std::string, std::vector<Rgb>> layers;
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const std::string side = k < count ? "" : "_back";
    layers[kRadiosity + side].push_back(sensors[k].mean);
    layers["error" + side].push_back(sensors[k].error);
    layers["half_a" + side].push_back(sensors[k].half_a);
    layers["half_b" + side].push_back(sensors[k].half_b);
  }
  std::vector<ElementLayer> list;
  list.reserve(layers.size());
  for (const auto& [name, values] : layers) list.push_back({name, values});
  write_element_file(file, elements, list);
}

void write_picture(const fs::path& file, const ReferenceOptions& options, const SensorLight& light) {
  LayeredImage image = layers_of(light);
  write_exr(file, image, attributes(options));
  Picture picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.radiance = std::move(image.layers[""]);
  picture.reflectance.assign(picture.pixels(), Rgb(0));
  picture.irradiance = picture.reflectance;
  write_png(fs::path(file).replace_extension(".png"), tone_map(picture, options.run.exposure));
}

Json measured_json(const SensorLight& light) {
  const ReferenceResult& result = light.measured;
  Json passes = Json::array();
  for (const ReferencePass& pass : result.passes)
    passes.push_back({{"samples", pass.samples},
                      {"rays", pass.rays},
                      {"seconds", pass.seconds},
                      {"cpu_s", pass.processor_seconds},
                      {"relative_error_rgb", triple(pass.relative_error)}});
  return {{"sensors", result.sensors.size()},
          {"samples", result.samples},
          {"rays", result.rays},
          {"seconds", light.seconds},
          {"mean_rgb", triple(result.mean)},
          {"relative_error_rgb", triple(result.relative_error)},
          {"reached", result.reached},
          {"passes", passes}};
}

}  // namespace

std::vector<fs::path> reference_outputs(const fs::path& folder, std::span<const Receiver> receivers) {
  std::vector<fs::path> files;
  for (const char* name :
       {"reference.ply", "reference.exr", "reference.png", "reference.json", "convergence.csv"})
    files.push_back(folder / name);
  for (const Receiver& receiver : receivers) files.push_back(folder / ("receiver-" + receiver.name + ".exr"));
  return files;
}

fs::path write_measured(const ReferenceOptions& options, const FileElements& elements,
                        const SensorLight& light) {
  const fs::path folder = options.run.out;
  if (light.name == "elements") {
    write_elements(folder / "reference.ply", elements, light);
    return folder / "reference.ply";
  }
  if (light.name == "picture") {
    write_picture(folder / "reference.exr", options, light);
    return folder / "reference.exr";
  }
  fs::path file = folder / receiver_file(light);
  write_exr(file, layers_of(light), attributes(options));
  return file;
}

void write_reference_report(const fs::path& file, const ReferenceOptions& options, const ReferenceRun& run,
                            const Solution& solution, const std::vector<PhaseRecord>& phases) {
  Json measured = Json::object();
  for (const SensorLight& light : solution.sensors) measured[light.name] = measured_json(light);
  const Json json{
      {"scene", options.run.scene}, {"version", version_text()}, {"ranks", run.ranks},
      {"threads", run.threads},     {"seed", options.seed},      {"randomisations", kRandomisations},
      {"load_s", run.load_seconds}, {"measured", measured},      {"forecasts", forecasts_json(phases)}};
  write_bytes_atomically(file, json.dump(2) + "\n");
}

}  // namespace fluxel

#include "output/reference_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "core/file.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "image/tone_map.hpp"
#include "output/convergence.hpp"
#include "output/json_parts.hpp"
#include "output/lighting_verdicts.hpp"
#include "output/option_json.hpp"
#include "output/outcome.hpp"
#include "output/receiver_files.hpp"
#include "output/version_text.hpp"

namespace fluxel {

namespace {

namespace fs = std::filesystem;

struct Measurement {
  const ReferenceOptions& options;
  const FileElements& elements;
  const SensorLight& light;
};

std::map<std::string, std::string> attributes(const Measurement& of) {
  std::map<std::string, std::string> text{{"fluxel.version", version_text()},
                                          {"fluxel.scene", of.options.run.scene},
                                          {"fluxel.seed", fmt::format("{}", of.options.seed)}};
  if (const std::string what = unreached(of.light.measured); !what.empty()) text["fluxel.unreached"] = what;
  return text;
}

/// Of fronts, then of backs where there are any; each layer by the names that compare knows.
void write_elements(const fs::path& file, const Measurement& of) {
  const std::vector<SensorEstimate>& sensors = of.light.measured.sensors;
  const std::size_t count = of.elements.outlines.size();
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
  write_element_file(file, of.elements, list, {}, unreached(of.light.measured));
}

/// By the names that compare knows.
LayeredImage layers_of(const SensorLight& light) {
  LayeredImage image{light.columns, light.rows, {}};
  const auto add = [&](const char* name, auto member) {
    std::vector<Rgb>& layer = image.layers[name];
    for (const SensorEstimate& sensor : light.measured.sensors) layer.push_back(sensor.*member);
  };
  add("", &SensorEstimate::mean);
  add("error", &SensorEstimate::error);
  add("half_a", &SensorEstimate::half_a);
  add("half_b", &SensorEstimate::half_b);
  return image;
}

void write_layers(const fs::path& file, const Measurement& of) {
  write_exr(file, layers_of(of.light), attributes(of));
}

void write_tone_mapped(const fs::path& file, const Measurement& of) {
  LayeredImage image = layers_of(of.light);
  Picture picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.radiance = std::move(image.layers[""]);
  picture.reflectance.assign(picture.pixels(), Rgb(0));
  picture.irradiance = picture.reflectance;
  write_png(file, tone_map(picture, of.options.run.exposure, of.options.run.tone));
}

/// A file of one kind of sensor; the first of a kind is the one to name to the user.
struct MeasuredRow {
  Measured kind;  ///< of the sensors; receivers have a file each, of their own names
  const char* name;
  void (*write)(const fs::path& file, const Measurement& of);
};

constexpr std::array kMeasuredFiles{MeasuredRow{Measured::elements, "reference.ply", write_elements},
                                    MeasuredRow{Measured::picture, "reference.exr", write_layers},
                                    MeasuredRow{Measured::picture, "reference.png", write_tone_mapped}};
constexpr const char* kReport = "reference.json";
constexpr const char* kConvergence = "convergence.csv";
constexpr const char* kReceiverTable = "receivers.csv";
constexpr const char* kTaskTable = "tasks.csv";

Json measured_json(const SensorLight& light) {
  const ReferenceResult& result = light.measured;
  Json passes = Json::array();
  for (const ReferencePass& pass : result.passes)
    passes.push_back({{"samples", pass.samples},
                      {"rays", pass.rays},
                      {"seconds", pass.seconds},
                      {"cpu_s", pass.processor_seconds},
                      {"relative_error_rgb", triple(pass.relative_error)}});
  Json json{{"sensors", result.sensors.size()},
            {"samples", result.samples},
            {"samples_min", result.least_samples},
            {"samples_max", result.most_samples},
            {"rays", result.rays},
            {"seconds", light.seconds},
            {"mean_rgb", triple(result.mean)},
            {"relative_error_rgb", triple(result.relative_error)},
            {"reached", result.reached},
            {"passes", passes}};
  return json;
}

}  // namespace

std::vector<fs::path> reference_outputs(const fs::path& folder, std::span<const Receiver> receivers) {
  std::vector<fs::path> files;
  files.reserve(kMeasuredFiles.size() + 4 + 2 * receivers.size());
  for (const MeasuredRow& row : kMeasuredFiles) files.push_back(folder / row.name);
  files.insert(files.end(),
               {folder / kReport, folder / kConvergence, folder / kReceiverTable, folder / kTaskTable});
  for (const Receiver& receiver : receivers)
    for (const char* const extension : {".exr", ".png"})
      files.push_back(folder / (receiver_stem(receiver) + extension));
  return files;
}

fs::path write_measured(const ReferenceOptions& options, const FileElements& elements,
                        const SensorLight& light) {
  const fs::path folder = options.run.out;
  fs::path first;
  for (const MeasuredRow& row : kMeasuredFiles) {
    if (row.kind != light.kind) continue;
    row.write(folder / row.name, {options, elements, light});
    if (first.empty()) first = folder / row.name;
  }
  if (!first.empty()) return first;
  fs::path file = folder / ("receiver-" + light.receiver + ".exr");
  write_layers(file, {options, elements, light});
  return file;
}

void write_reference_report(const fs::path& folder, const ReferenceOptions& options, const Scene& scene,
                            const ReferenceRun& run, const Solution& solution,
                            const std::vector<PhaseRecord>& phases) {
  Json measured = Json::object();
  for (const SensorLight& light : solution.sensors) measured[light.name()] = measured_json(light);
  const std::vector<StatedReceiver> receivers = stated_receivers(scene, solution.sensors, 0);
  for (const StatedReceiver& of : receivers) {
    measured[of.light.name()].update(figures_json(of.figures));
    write_receiver_map(folder, of, scene.units, options.run.false_colour);
  }
  if (!receivers.empty()) write_receiver_table(folder / kReceiverTable, scene, receivers);
  Json json{{"ranks", run.ranks},
            {"threads", run.threads},
            {"options", options_json(options)},
            {"version", version_text()},
            {"randomisations", kRandomisations},
            {"load_s", run.load_seconds},
            {"measured", measured},
            {"progress", progress_json(phases)}};
  if (solution.ray_devices) json["gpu"] = gpu_json(*solution.ray_devices, "paths");
  const std::vector<ObserverRating> observers = observer_ratings(solution.glare, 0);
  if (!observers.empty()) json["observers"] = observers_json(observers);
  if (!scene.tasks.empty() && options.measures(Measured::receivers)) {
    const std::vector<TaskVerdict> tasks =
        judge_tasks(scene, receivers, observers, options.run.maintenance_factor);
    json["tasks"] = tasks_json(tasks);
    write_task_table(folder / kTaskTable, tasks, std::ranges::all_of(receivers, [](const StatedReceiver& of) {
                       return of.unreached.empty();
                     }));
  }
  write_convergence(folder / kConvergence, phases);
  write_bytes_atomically(folder / kReport, json_text(json));
}

}  // namespace fluxel

#include "output/measured_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/options.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "image/tone_map.hpp"
#include "output/lighting_verdicts.hpp"
#include "output/outcome.hpp"
#include "output/receiver_files.hpp"
#include "output/version_text.hpp"

namespace fluxel {

namespace {

namespace fs = std::filesystem;

struct Measurement {
  const MeasuredRun& run;
  const FileElements& elements;
  const SensorLight& light;
};

std::map<std::string, std::string> measured_attributes(const Measurement& of) {
  std::map<std::string, std::string> text{{"fluxel.version", version_text()},
                                          {"fluxel.scene", of.run.options.scene},
                                          {"fluxel.seed", fmt::format("{}", of.run.seed)}};
  if (const std::string what = unreached(of.light.measured); !what.empty()) text["fluxel.unreached"] = what;
  return text;
}

/// Of fronts, then of backs where there are any; each layer by the names that compare knows.
void write_measured_elements(const fs::path& file, const Measurement& of) {
  const std::size_t count = of.elements.outlines.size();
  std::map<std::string, std::vector<Rgb>> layers;
  const auto add = [&](const std::vector<SensorEstimate>& sensors, const std::string& values,
                       const std::string& prefix) {
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      const std::string side = k < count ? "" : "_back";
      layers[values + side].push_back(sensors[k].mean);
      const auto name_of = [&](const char* what) { return fmt::format("{}{}{}", prefix, what, side); };
      if (of.light.knows_each_error) layers[name_of("error")].push_back(sensors[k].error);
      layers[name_of("half_a")].push_back(sensors[k].half_a);
      layers[name_of("half_b")].push_back(sensors[k].half_b);
    }
  };
  add(of.light.measured.sensors, kRadiosity, "");
  add(of.light.irradiance, "irradiance", "irradiance_");
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
  if (light.knows_each_error) add("error", &SensorEstimate::error);
  add("half_a", &SensorEstimate::half_a);
  add("half_b", &SensorEstimate::half_b);
  return image;
}

void write_layers(const fs::path& file, const Measurement& of) {
  write_exr(file, layers_of(of.light), measured_attributes(of));
}

void write_tone_mapped(const fs::path& file, const Measurement& of) {
  write_png(file, display_of(of.run, of.light));
}

/// A file of one kind of sensor; the first of a kind is the one to name to the user.
struct MeasuredRow {
  Measured kind;  ///< of the sensors; receivers have a file each, of their own names
  const char* extension;
  void (*write)(const fs::path& file, const Measurement& of);
};

constexpr std::array kMeasuredFiles{MeasuredRow{Measured::elements, ".ply", write_measured_elements},
                                    MeasuredRow{Measured::picture, ".exr", write_layers},
                                    MeasuredRow{Measured::picture, ".png", write_tone_mapped}};
constexpr const char* kReceiverTable = "receivers.csv";
constexpr const char* kTaskTable = "tasks.csv";

}  // namespace

DisplayPicture display_of(const MeasuredRun& run, const SensorLight& light) {
  Picture picture;
  picture.width = light.columns;
  picture.height = light.rows;
  for (const SensorEstimate& sensor : light.measured.sensors) picture.radiance.push_back(sensor.mean);
  picture.reflectance.assign(picture.pixels(), Rgb(0));
  picture.irradiance = picture.reflectance;
  return tone_map(picture, run.options.exposure, run.options.tone);
}

std::vector<fs::path> measured_outputs(const fs::path& folder, const std::string& stem,
                                       std::span<const Receiver> receivers) {
  std::vector<fs::path> files{folder / (stem + ".json"), folder / (stem + ".html"),
                              folder / "convergence.csv", folder / kReceiverTable, folder / kTaskTable};
  for (const MeasuredRow& row : kMeasuredFiles) files.push_back(folder / (stem + row.extension));
  for (const Receiver& receiver : receivers)
    for (const char* const extension : {".exr", ".png"})
      files.push_back(folder / (receiver_stem(receiver) + extension));
  return files;
}

fs::path write_measured(const MeasuredRun& run, const FileElements& elements, const SensorLight& light) {
  const fs::path folder = run.options.out;
  fs::path first;
  for (const MeasuredRow& row : kMeasuredFiles) {
    if (row.kind != light.kind) continue;
    const fs::path file = folder / (run.stem + row.extension);
    row.write(file, {run, elements, light});
    if (first.empty()) first = file;
  }
  if (!first.empty()) return first;
  fs::path file = folder / ("receiver-" + light.receiver + ".exr");
  write_layers(file, {run, elements, light});
  return file;
}

void write_meters(const MeasuredRun& run, const Scene& scene, const Solution& solution, Json& report) {
  const fs::path folder = run.options.out;
  const std::vector<StatedReceiver> receivers = stated_receivers(scene, solution.sensors);
  for (const StatedReceiver& of : receivers) {
    report["measured"][of.light.name()].update(figures_json(of.figures));
    write_receiver_map(folder, of, scene.units, run.options.false_colour);
  }
  if (!receivers.empty()) write_receiver_table(folder / kReceiverTable, scene, receivers);
  const std::vector<ObserverRating> observers = observer_ratings(solution.glare);
  if (!observers.empty()) report["observers"] = observers_json(observers);
  if (scene.tasks.empty() || receivers.empty()) return;
  const std::vector<TaskVerdict> tasks =
      judge_tasks(scene, receivers, observers, run.options.maintenance_factor);
  report["tasks"] = tasks_json(tasks);
  write_task_table(folder / kTaskTable, tasks, std::ranges::all_of(receivers, [](const StatedReceiver& of) {
                     return of.unreached.empty();
                   }));
}

}  // namespace fluxel

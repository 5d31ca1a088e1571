#include "output/reference_files.hpp"

#include "core/file.hpp"
#include "core/options.hpp"
#include "output/convergence.hpp"
#include "output/json_parts.hpp"
#include "output/measured_page.hpp"
#include "output/option_json.hpp"
#include "output/version_text.hpp"

namespace fluxel {

namespace {

namespace fs = std::filesystem;

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
            {"quadratic_error_rgb", triple(result.quadratic_error)},
            {"reached", result.reached},
            {"ended_by", sentence_of(result.ending)},
            {"passes", passes}};
  return json;
}

}  // namespace

void write_reference_report(const ReferenceOptions& options, const Scene& scene, const MeasuredCost& cost,
                            const Solution& solution, const FileElements& elements,
                            const std::vector<PhaseRecord>& phases) {
  const fs::path folder = options.run.out;
  Json measured = Json::object();
  for (const SensorLight& light : solution.sensors) measured[light.name()] = measured_json(light);
  Json json{
      {"ranks", cost.ranks},       {"threads", cost.threads},           {"options", options_json(options)},
      {"version", version_text()}, {"randomisations", kRandomisations}, {"load_s", cost.load_seconds},
      {"measured", measured},      {"progress", progress_json(phases)}};
  if (solution.ray_devices) json["gpu"] = gpu_json(*solution.ray_devices, "paths");
  write_meters(measured_run(options), scene, solution, json);
  write_convergence(folder / "convergence.csv", phases);
  json = without_unknown(json);
  write_bytes_atomically(folder / "reference.json", json_text(json));
  write_measured_page(measured_run(options), scene, elements, solution, cost, json);
}

}  // namespace fluxel

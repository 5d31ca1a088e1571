#include "output/photon_files.hpp"

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

Json kind_json(const SensorLight& light, const PhotonStatistics& photons, std::size_t kind) {
  const ReferenceResult& result = light.measured;
  Json turns = Json::array();
  for (const PhotonTurn& turn : photons.turns)
    turns.push_back({{"photons", turn.photons},
                     {"seconds", turn.seconds},
                     {"cpu_s", turn.processor_seconds},
                     {"irradiance_rgb", triple(turn.errors[kind].mean)},
                     {"error_rgb", triple(turn.errors[kind].error)}});
  return {{"sensors", result.sensors.size()},
          {"received", result.rays},
          {"irradiance_rgb", triple(result.mean)},
          {"relative_error_rgb", triple(result.relative_error)},
          {"quadratic_error_rgb", triple(result.quadratic_error)},
          {"error_of_each", light.knows_each_error},
          {"reached", result.reached},
          {"turns", turns}};
}

Json renewal_json(const RenewalResult& renewal) {
  Json turns = Json::array();
  for (const RenewalTurn& turn : renewal.turns)
    turns.push_back({{"groups", turn.groups},
                     {"renewed", turn.renewed},
                     {"changed", turn.changed},
                     {"left", turn.left},
                     {"seconds", turn.seconds}});
  return {{"photons", renewal.photons},     {"groups", renewal.groups},
          {"pilots", renewal.pilots},       {"changed_pilots", renewal.changed_pilots},
          {"complete", renewal.complete()}, {"turns", turns}};
}

double per(std::uint64_t count, std::uint64_t photons) {
  return photons > 0 ? static_cast<double>(count) / static_cast<double>(photons) : 0;
}

}  // namespace

fs::path tally_path(const PhotonOptions& options) {
  const std::string& folder = options.run.checkpoint.empty() ? options.run.out : options.run.checkpoint;
  return fs::path(folder) / "photons.tally";
}

void write_photon_report(const PhotonOptions& options, const Scene& scene, const MeasuredCost& cost,
                         const Solution& solution, const FileElements& elements,
                         const std::vector<PhaseRecord>& phases) {
  const fs::path folder = options.run.out;
  const PhotonStatistics& photons = *solution.photons;
  Json measured = Json::object();
  for (std::size_t kind = 0; kind < solution.sensors.size(); ++kind)
    measured[solution.sensors[kind].name()] = kind_json(solution.sensors[kind], photons, kind);
  Json json{{"ranks", cost.ranks},
            {"threads", cost.threads},
            {"options", options_json(options)},
            {"version", version_text()},
            {"load_s", cost.load_seconds},
            {"photons",
             {{"sent", photons.sent},
              {"restored", photons.restored},
              {"rays_each", per(photons.rays, photons.sent)},
              {"coordinates_each", per(photons.coordinates, photons.sent)},
              {"seconds", solution.time.solve.wall},
              {"cpu_s", photons.turns.empty() ? 0.0 : photons.turns.back().processor_seconds},
              {"ended_by", photons.ending}}},
            {"energy",
             {{"emitted_mean", photons.power},
              {"absorbed_rgb", triple(photons.absorbed)},
              {"escaped_rgb", triple(photons.escaped)},
              {"lost_rgb", triple(photons.lost)}}},
            {"measured", measured},
            {"progress", progress_json(phases)}};
  if (photons.renewal) json["renewal"] = renewal_json(*photons.renewal);
  write_meters(measured_run(options), scene, solution, json);
  write_convergence(folder / "convergence.csv", phases);
  json = without_unknown(json);
  write_bytes_atomically(folder / "photons.json", json_text(json));
  write_measured_page(measured_run(options), scene, elements, solution, cost, json);
}

}  // namespace fluxel

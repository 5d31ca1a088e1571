#include "bench/visibility/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/visibility/csv_file.hpp"
#include "bench/visibility/engine.hpp"
#include "bench/visibility/growth.hpp"
#include "bench/visibility/scenes.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "bench/visibility/subdivision_time.hpp"
#include "core/error.hpp"
#include "core/hash.hpp"
#include "metrics/progress_recorder.hpp"

namespace fluxel::bench {

namespace {

/// The scenes to run: the one that is asked for, else `usual` (all where that is empty).
std::vector<SceneSource> choose(const Choice& choice, const std::set<std::string>& usual = {}) {
  std::vector<SceneSource> chosen;
  bool known = false;
  for (const SceneSource& source : scene_sources(choice.large_scenes)) {
    const bool wanted =
        choice.only.empty() ? usual.empty() || usual.contains(source.name) : source.name == choice.only;
    known = known || wanted;
    if (!wanted) continue;
    if (std::filesystem::exists(source.file)) {
      chosen.push_back(source);
    } else {
      fmt::print(stderr, "{}: skipped, {} is not there (--scenes names the folder of large scenes)\n",
                 source.name, source.file.string());
    }
  }
  if (!known) throw InputError(fmt::format("no scene of the benchmark is named '{}'", choice.only));
  if (chosen.empty()) throw InputError("no scene to measure");
  return chosen;
}

NumberColumns columns_of(const Measurement& m) {
  return {{"elements", static_cast<double>(m.elements)},
          {"tiles", static_cast<double>(m.tiles)},
          {"traced_tiles", static_cast<double>(m.traced_tiles)},
          {"seconds", m.seconds},
          {"pairs_per_second", m.pairs_per_second},
          {"rays_per_second", m.rays_per_second},
          {"raw_rays_per_second", m.raw_rays_per_second},
          {"ratio", m.ratio},
          {"rays_a_pair", m.rays_a_pair},
          {"without_rays", m.without_rays},
          {"one_value", m.one_value},
          {"bits_a_pair", m.bits_a_pair},
          {"mixed_8", m.mixed_8},
          {"mixed_4", m.mixed_4},
          {"differing", static_cast<double>(m.differing)},
          {"classical_seconds", m.classical_seconds},
          {"leaky_rays_per_second", m.leaky_rays_per_second}};
}

NumberColumns columns_of(int resolution, const SubdivisionTime& time) {
  return {{"resolution", resolution},
          {"elements", static_cast<double>(time.elements)},
          {"raster_seconds", time.raster_seconds},
          {"split_seconds", time.split_seconds}};
}

void print_visibility_heads() {
  fmt::print("{:>8} {:>9} {:>8} {:>8} {:>8} {:>8} {:>6} {:>7} {:>7} {:>8} {:>6} {:>6} {:>6} {:>9}\n", "N",
             "s", "Mpairs/s", "Mrays/s", "raw", "leaky", "ratio", "no ray%", "1 val%", "bits/pr", "8x8%",
             "4x4%", "differ", "classic s");
}

void print_line(const Measurement& m) {
  fmt::print("{:8} {:9.3g} {:8.1f} {:8.2f} {:8.2f} {:8.2f} {:6.2f} {:7.1f} {:7.1f} {:8.4f} {:6.1f} {:6.1f}",
             m.elements, m.seconds, m.pairs_per_second * 1e-6, m.rays_per_second * 1e-6,
             m.raw_rays_per_second * 1e-6, m.leaky_rays_per_second * 1e-6, m.ratio, 100 * m.without_rays,
             100 * m.one_value, m.bits_a_pair, 100 * m.mixed_8, 100 * m.mixed_4);
  fmt::print(" {:6} {:9.3g}{}\n", m.differing, m.classical_seconds,
             m.traced_tiles < m.tiles ? fmt::format("  ({} of {} tiles)", m.traced_tiles, m.tiles) : "");
  std::fflush(stdout);
}

}  // namespace

void run_visibility(const Choice& choice, const std::vector<std::size_t>& sizes,
                    const MeasureSettings& settings, const std::string& csv) {
  const std::vector<SceneSource> sources = choose(choice);
  CsvFile table(csv);
  ConsoleDisplay console;
  ProgressRecorder progress(console);
  for (const SceneSource& source : sources) {
    const Scene scene = load_scene(source, choice.triangles).scene;
    fmt::print("\n{}: {} patches; one thread, pairs of N^2\n", source.name, scene.patches.size());
    print_visibility_heads();
    std::vector<std::pair<double, double>> engine, classical;
    std::set<std::size_t> done;
    for (const std::size_t size : sizes) {
      const ElementMesh mesh = subdivide_to_size(scene, size);
      if (!done.insert(mesh.elements.size()).second) continue;  // a scene has no fewer than its pieces
      progress.begin(fmt::format("{}, {} elements", source.name, mesh.elements.size()));
      const Measurement found = measure(scene, mesh, settings, progress);
      progress.end();
      print_line(found);
      table.add({{"scene", source.name}}, columns_of(found));
      const auto elements = static_cast<double>(found.elements);
      engine.emplace_back(elements, found.seconds);
      if (settings.classical) classical.emplace_back(elements, found.classical_seconds);
    }
    fmt::print("time [s]: {}; with the elements as occluders: {}\n", describe(fit_power_law(engine), "N"),
               describe(fit_power_law(classical), "N"));
  }
}

void run_subdivision(const Choice& choice, const std::vector<int>& resolutions, int repetitions,
                     const std::string& csv) {
  const std::vector<SceneSource> sources =
      choose(choice, {"cornell-box", "construction-in-wood", "room-of-12-boxes"});
  CsvFile table(csv);
  for (const SceneSource& source : sources) {
    const LoadedScene loaded = load_scene(source, choice.triangles);
    if (!loaded.camera) throw InputError(fmt::format("{} has no camera", source.name));
    fmt::print("\n{}: {} patches; one thread\n{:>10} {:>9} {:>9} {:>9} {:>9}\n", source.name,
               loaded.scene.patches.size(), "pixels", "elements", "raster s", "split s", "s");
    std::vector<std::pair<double, double>> points;
    for (const int resolution : resolutions) {
      const SubdivisionTime time = time_subdivision(loaded.scene, *loaded.camera, resolution, repetitions);
      const double seconds = time.raster_seconds + time.split_seconds;
      fmt::print("{:>10} {:>9} {:>9.3g} {:>9.3g} {:>9.3g}\n", fmt::format("{0}x{0}", resolution),
                 time.elements, time.raster_seconds, time.split_seconds, seconds);
      std::fflush(stdout);
      table.add({{"scene", source.name}}, columns_of(resolution, time));
      points.emplace_back(resolution, seconds);
    }
    fmt::print("time [s]: {}, R pixels a side\n", describe(fit_power_law(points), "R"));
  }
}

void run_trace(const Choice& choice, std::size_t size) {
  const Scene scene = load_scene(choose(choice)[0], choice.triangles).scene;
  const ElementMesh mesh = subdivide_to_size(scene, size);
  const RayScene ray_scene(scene, 1);
  const Engine engine{ray_scene, mesh.elements};
  const std::vector<TilePlace> places = upper_triangle(mesh.elements.size());
  constexpr std::size_t kBatch = 64;
  std::vector<TracedTile> tiles;
  std::uint64_t rays = 0, hash = 0;
  double seconds = 0;
  for (std::size_t first = 0; first < places.size(); first += kBatch) {
    const auto batch = std::span(places).subspan(first, std::min(kBatch, places.size() - first));
    seconds += thread_seconds_of([&] { engine.trace(batch, tiles); });
    for (const TracedTile& tile : tiles) {
      rays += tile.rays;
      hash = hash_bytes(std::as_bytes(std::span(tile.bits)), hash);
    }
  }
  fmt::print("{} elements, {} rays, {:.3f} s, bits {}\n", mesh.elements.size(), rays, seconds,
             hash_text(hash));
}

}  // namespace fluxel::bench

#include "bench/solver/operator_rates.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "bench/visibility/csv_file.hpp"
#include "bench/visibility/engine.hpp"
#include "bench/visibility/scenes.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "core/error.hpp"
#include "formfactor/tile_bounds.hpp"
#include "solver/row_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel::bench {

namespace {

TileStore trace_all(const Scene& scene, std::span<const Element> elements) {
  const RayScene ray_scene(scene, 2);  // its limit on threads is the whole program's
  const TileTracer tracer(ray_scene, elements);
  TileStore store(tile_count(elements.size()), {0, tile_count(elements.size())});
  for (const auto& [row, column] : upper_triangle(elements.size())) {
    const TracedTile tile = tracer.trace(row, column);
    store.put(row, column, tile.tag, tile.bits);
  }
  return store;
}

/// Of all N^2 tiles: those that send at all, those with bits, those for the moments rule.
struct TileShares {
  double sending = 0, mixed = 0, near = 0;
};

TileShares shares_of(const TileStore& store, std::span<const Element> elements, const KernelRule& kernel) {
  std::vector<TileShape> shapes;
  for (std::size_t tile = 0; tile < store.tiles(); ++tile) shapes.push_back(tile_shape(elements, tile));
  TileShares shares;
  const double each = 1 / static_cast<double>(store.tiles() * store.tiles());
  for (std::size_t row = 0; row < store.tiles(); ++row) {
    for (std::size_t column = 0; column < store.tiles(); ++column) {
      const TileTag tag = store.tag(row, column);
      if (tag != TileTag::bits && tag != TileTag::visible) continue;
      shares.sending += each;
      if (tag == TileTag::bits) shares.mixed += each;
      if (rule_between(shapes[row], shapes[column], kernel) == PairRule::moments) shares.near += each;
    }
  }
  return shares;
}

/// Vectors of both kinds: all light, and the luminaires' alone.
struct Vectors {
  std::vector<Rgb> all, emitted;
  std::vector<double> all_grey, emitted_grey;

  Vectors(const Scene& scene, std::span<const Element> elements)
      : emitted(make_unknowns(elements, scene.materials).E) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> value(0.5, 1.5);
    for (const Rgb& E : emitted) {
      all.emplace_back(value(random), value(random), value(random));
      all_grey.push_back(all.back().g);
      emitted_grey.push_back(E.g);
    }
  }
};

/// One apply [s]: wall-clock time, and what the calling thread itself was busy.
struct Duration {
  double wall = 0, busy = 0;
};

/// Name of what was timed: its repetitions.
using Durations = std::map<std::string, std::vector<Duration>>;

void time_once(RowOperator& F, const Vectors& vectors, const std::string& threads, Durations& durations) {
  std::vector<Rgb> H(vectors.all.size());
  std::vector<double> H_grey(vectors.all.size());
  const auto time = [&](const std::string& name, const auto& x, auto& result) {
    Duration duration;
    duration.wall = seconds_of([&] { duration.busy = thread_seconds_of([&] { F.apply(x, result); }); });
    durations[name + threads].push_back(duration);
  };
  time("RGB", vectors.all, H);
  time("grey", vectors.all_grey, H_grey);
  time("RGB-emitters", vectors.emitted, H);
  time("grey-emitters", vectors.emitted_grey, H_grey);
}

/// Median of the ratios inside a repetition.
double ratio(const std::vector<Duration>& slow, const std::vector<Duration>& fast, double Duration::*time) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < slow.size(); ++k) ratios.push_back(slow[k].*time / fast[k].*time);
  return median(ratios);
}

void measure_rule(const std::string& scene, const char* name, const KernelRule& kernel,
                  const TileStore& store, std::span<const Element> elements, const Vectors& vectors,
                  int repetitions, CsvFile& table) {
  const Corrections none;
  RowOperator one(elements, store, none, kernel, false, 1), two(elements, store, none, kernel, false, 2);
  Durations durations;
  for (int k = 0; k < repetitions; ++k) {
    time_once(one, vectors, "-1", durations);
    time_once(two, vectors, "-2", durations);
  }
  const TileShares shares = shares_of(store, elements, kernel);
  const double pairs = static_cast<double>(elements.size()) * static_cast<double>(elements.size());
  const auto rate = [&](const std::string& what) {
    std::vector<double> rates;
    for (const Duration& duration : durations.at(what)) rates.push_back(pairs / duration.busy);
    return median(rates);
  };
  NumberColumns numbers{{"elements", static_cast<double>(elements.size())},
                        {"sending", shares.sending},
                        {"mixed", shares.mixed},
                        {"near", shares.near}};
  fmt::print("{:>18} {:>8} {:7} {:5.1f} {:5.1f} {:5.1f}", scene, name, elements.size(), 100 * shares.sending,
             100 * shares.mixed, 100 * shares.near);
  for (const auto& what : {"RGB-1", "grey-1"}) {
    numbers.emplace_back(what, rate(what));
    fmt::print(" {:7.3f}", 1e-9 * rate(what));
  }
  for (const auto& [title, slow, fast, time] :
       {std::tuple{"grey-ratio", "RGB-1", "grey-1", &Duration::busy},
        std::tuple{"emitters-ratio", "RGB-1", "RGB-emitters-1", &Duration::busy},
        std::tuple{"threads-ratio", "RGB-1", "RGB-2", &Duration::wall}}) {
    numbers.emplace_back(title, ratio(durations.at(slow), durations.at(fast), time));
    fmt::print(" {:8.2f}", numbers.back().second);
  }
  fmt::print("\n");
  std::fflush(stdout);
  table.add({{"scene", scene}, {"rule", name}}, numbers);
}

}  // namespace

void run_operator(const OperatorSettings& settings) {
  const std::set<std::string> usual{"room-of-12-boxes", "room-of-180-boxes", "room-12"};
  CsvFile table(settings.csv);
  bool measured = false;
  fmt::print("10^9 pairs of N^2 a second; tiles in per cent of all\n");
  fmt::print("{:>18} {:>8} {:>7} {:>5} {:>5} {:>5} {:>7} {:>7} {:>8} {:>8} {:>8}\n", "scene", "rule", "N",
             "send", "mixed", "near", "RGB", "grey", "RGB/grey", "all/lum", "2 thr.");
  for (const SceneSource& source : scene_sources(settings.large_scenes)) {
    const bool wanted = settings.only.empty() ? usual.contains(source.name) : source.name == settings.only;
    if (!wanted || !std::filesystem::exists(source.file)) continue;
    const Scene scene = load_scene(source, false).scene;
    const ElementMesh mesh = subdivide_to_size(scene, settings.elements);
    const TileStore store = trace_all(scene, mesh.elements);
    const Vectors vectors(scene, mesh.elements);
    FormFactorOptions adaptive;
    measure_rule(source.name, "point", PairRule::point, store, mesh.elements, vectors, settings.repetitions,
                 table);
    measure_rule(source.name, "adaptive", kernel_rule(adaptive), store, mesh.elements, vectors,
                 settings.repetitions, table);
    measured = true;
  }
  if (!measured) throw InputError("no scene to measure");
}

}  // namespace fluxel::bench

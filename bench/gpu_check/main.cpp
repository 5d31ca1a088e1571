// Whether the code for GPUs is right, and how fast: see CMakeLists.txt here for how to build it alone.
//   visibility_cuda_check [--quick] [--out FILE.json] [--device NUMBER] [--threads COUNT]
// Without a device the code is checked on the host. Ends with 1 where anything differs, with 2 where it could
// not do its work.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/gpu_check/tables.hpp"

namespace fluxel::cuda::checks {

namespace {

struct Options {
  bool quick = false;
  std::string out;
  int device = 0;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
};

Options read_options(const std::vector<std::string>& arguments) {
  Options options;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& name = arguments[k];
    if (name == "--quick") {
      options.quick = true;
      continue;
    }
    if ((name != "--out" && name != "--device" && name != "--threads") || k + 1 == arguments.size())
      throw std::invalid_argument(
          "usage: visibility_cuda_check [--quick] [--out FILE.json] [--device NUMBER] [--threads COUNT]");
    const std::string& value = arguments[++k];
    if (name == "--out") {
      options.out = value;
      continue;
    }
    if (value.empty() || value.size() > 4 || value.find_first_not_of("0123456789") != std::string::npos)
      throw std::invalid_argument(
          std::string(name).append(" needs a number, not '").append(value).append("'"));
    if (name == "--device") options.device = std::stoi(value);
    if (name == "--threads") options.threads = static_cast<unsigned>(std::max(1, std::stoi(value)));
  }
  return options;
}

/// How long to look, for an answer in a minute or for figures.
struct Effort {
  double segment_tests;      // of a scene by brute force
  std::size_t known_tiles;   // of a scene where nothing sees anything
  std::size_t device_tiles;  // of a scene, compared with the host's
  double seconds;            // of a benchmark
  std::size_t counted_tiles;
  HitEffort hits;
  std::size_t paths;
  std::size_t spheres, points;  // of an octree
  std::vector<std::size_t> elements;
};

Effort effort_of(const Options& options) {
  if (options.quick) return {1e8, 250, 1000, 0.5, 100, {3e7, 1000000}, 200000, 30000, 300000, {24576}};
  return {1e10,     10000,
          10000,    10,
          1000,     {3e9, 20000000},
          10000000, 1000000,
          10000000, {24576, 50000, 100000, 200000}};
}

constexpr Boxes kFew{12, 1, 0.6}, kMany{180, 1, 0.6}, kCloud{31000, 15, 0.3};

std::vector<CheckScene> benchmark_scenes() {
  return {room_with(kFew, Outlines::triangles), room_with(kMany, Outlines::triangles),
          room_with(kCloud, Outlines::triangles)};
}

class Program {
 public:
  explicit Program(const Options& options) : options_(options), effort_(effort_of(options)) {
    if (!options.out.empty() && !std::ofstream(options.out, std::ios::app))
      throw std::runtime_error(options.out + " cannot be written");
    DeviceFigures& device = results_.device;
    const std::vector<DeviceProperties> devices = find_devices(device.why_not);
    if (devices.empty()) return;
    if (static_cast<std::size_t>(options.device) >= devices.size())
      throw std::invalid_argument("there is no device " + std::to_string(options.device) +
                                  ": the last one is number " + std::to_string(devices.size() - 1));
    device.measured = true;
    device.properties = devices[static_cast<std::size_t>(options.device)];
    device.limits = limits_of(options.device);
  }

  /// What the code says, against what is right.
  void check() {
    for (const CheckScene& scene : benchmark_scenes()) check(scene, 24576);
    check(room_with(kMany, Outlines::parallelograms), 24576);
    check(closed_sheet(0), 8192);
    check(closed_sheet(0.5), 8192);
    check(mixed_sheet(), 8192);
    check(random_plates(), 4096);
    check_rays();
    for (const CheckScene& scene : benchmark_scenes())
      results_.paths.push_back(check_paths(scene, effort_.paths, device_or_none(), options_.threads));
    results_.octrees = check_octrees(effort_.spheres, effort_.points, device_or_none());
  }

  void measure() {
    for (const CheckScene& scene : benchmark_scenes())
      for (const std::size_t elements : effort_.elements) measure(scene, elements);
    if (!results_.device.measured) return;
    measure_launches();
    results_.rows = check_rows_on_device(effort_.elements, options_.device, free_memory_of(options_.device));
  }

  /// Returns whether all was right.
  [[nodiscard]] bool report() const {
    print_figures(results_);
    if (!options_.out.empty()) {
      std::ofstream file(options_.out);
      file << to_json(results_);
      file.close();
      if (!file) throw std::runtime_error(options_.out + " cannot be written");
    }
    std::size_t wrong = 0;
    for (const Comparison& comparison : results_.comparisons) wrong += comparison.differing > 0 ? 1 : 0;
    for (const RowFigures& row : results_.rows) wrong += row.right() ? 0 : 1;
    for (const HitFigures& row : results_.hits) wrong += row.right() ? 0 : 1;
    for (const PathFigures& row : results_.paths) wrong += row.right() ? 0 : 1;
    for (const OctreeFigures& row : results_.octrees) wrong += row.right() ? 0 : 1;
    std::printf("\n%zu comparisons, %zu with differences\n",
                results_.comparisons.size() + results_.rows.size() + results_.hits.size() +
                    results_.paths.size() + results_.octrees.size(),
                wrong);
    return wrong == 0;
  }

 private:
  [[nodiscard]] DeviceTracer tracer_for(const SceneArrays& arrays) const {
    return {arrays, options_.device, free_memory_of(options_.device)};
  }

  /// Negative: there is none.
  [[nodiscard]] int device_or_none() const { return results_.device.measured ? options_.device : -1; }

  void keep(const Comparison& comparison) {
    // A comparison of nothing would find no difference.
    if (comparison.facing == 0) throw std::logic_error("no pairs face each other in " + comparison.scene);
    print_comparison(comparison);
    results_.comparisons.push_back(comparison);
  }

  void check(const CheckScene& scene, std::size_t elements) {
    const SceneArrays arrays = arrays_of(scene, elements);
    const CheckedScene checked{scene, arrays, elements};
    keep(scene.sees_nothing ? compare_with_nothing_seen(checked, effort_.known_tiles, options_.threads)
                            : compare_with_brute_force(checked, effort_.segment_tests, options_.threads));
    if (!results_.device.measured) return;
    DeviceTracer tracer = tracer_for(arrays);
    keep(compare_with_device(checked, tracer, effort_.device_tiles, options_.threads));
  }

  /// First hits in all scenes, and how fast they are found.
  void check_rays() {
    std::vector<CheckScene> scenes = benchmark_scenes();
    for (CheckScene scene : {room_with(kMany, Outlines::parallelograms), closed_sheet(0), closed_sheet(0.5),
                             mixed_sheet(), random_plates()})
      scenes.push_back(std::move(scene));
    for (const CheckScene& scene : scenes) {
      results_.hits.push_back(check_hits(scene, effort_.hits, device_or_none(), options_.threads));
      // A comparison of misses would find no difference.
      if (results_.hits.back().hits == 0) throw std::logic_error("no ray meets anything in " + scene.name);
    }
  }

  void measure(const CheckScene& scene, std::size_t elements) {
    const SceneArrays arrays = arrays_of(scene, elements);
    Figures figures{scene.name, scene.patches.size(), elements, {}, {}, {}, {}};
    figures.work = count_work(arrays, effort_.counted_tiles, options_.threads);
    figures.host = speed_of_host(arrays, elements, std::min(effort_.seconds, 2.0));
    if (results_.device.measured) {
      DeviceTracer tracer = tracer_for(arrays);
      figures.device = speed_of_device(arrays, elements, tracer, effort_.seconds);
      figures.by_launch = speed_of_device(arrays, elements, tracer, 0.2 * effort_.seconds, kTilesOfLaunch);
    }
    results_.figures.push_back(figures);
    std::printf("%s, %zu elements: measured\n", scene.name.c_str(), elements);
    std::fflush(stdout);
  }

  void measure_launches() {
    const CheckScene scene = room_with(kMany, Outlines::triangles);
    const std::size_t elements = effort_.elements.back();
    const SceneArrays arrays = arrays_of(scene, elements);
    DeviceTracer tracer = tracer_for(arrays);
    results_.device.launch_scene = scene.name + ", " + std::to_string(elements) + " elements";
    for (std::size_t tiles = 64; tiles <= kTilesOfLaunch; tiles *= 4)
      results_.device.launches.push_back(
          {tiles, speed_of_device(arrays, elements, tracer, 0.2 * effort_.seconds, tiles)});
  }

  Options options_;
  Effort effort_;
  Results results_;
};

bool run(const std::vector<std::string>& arguments) {
  const Options options = read_options(arguments);
  Program program(options);
  program.check();
  program.measure();
  return program.report();
}

}  // namespace

}  // namespace fluxel::cuda::checks

int main(int count, char** arguments) {
  try {
    return fluxel::cuda::checks::run({arguments + 1, arguments + count}) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "visibility_cuda_check: %s\n", error.what());
    return 2;
  }
}

#include "bench/gpu_check/tables.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "bench/gpu_check/json.hpp"

namespace fluxel::cuda::checks {

namespace {

constexpr const char* kWorkNames[kKindsOfWork] = {"boxes_of_shafts", "patches_of_shafts", "boxes_of_rays",
                                                  "patches_of_rays", "exact_patches"};

/// What the device's limits allow at most [pairs of N^2 /s], which are twice those that are made.
struct Ceilings {
  double operations, memory, copy_to_host;
};

Ceilings ceilings_of(const WorkOfPair& work, const DeviceLimits& limits) {
  const double seconds_of_operations =
      work.single_operations / limits.single_operations + work.double_operations / limits.double_operations;
  return {2 / seconds_of_operations, 2 * limits.copy_on_device / work.bytes,
          2 * limits.copy_to_host / work.bytes};
}

void print_limits(const DeviceFigures& device) {
  std::printf("\n%s, compute capability %d.%d, %d multiprocessors, %.1f GB\n", device.properties.name.c_str(),
              device.properties.major, device.properties.minor, device.properties.multiprocessors,
              1e-9 * static_cast<double>(device.properties.memory));
  std::printf("copies, measured: on the device %.0f GB/s, to it %.1f GB/s, to the host %.1f GB/s\n",
              1e-9 * device.limits.copy_on_device, 1e-9 * device.limits.copy_to_device,
              1e-9 * device.limits.copy_to_host);
  std::printf(
      "products and sums, by the card's properties: %.1f T/s in single precision, %.1f T/s in double\n",
      1e-12 * device.limits.single_operations, 1e-12 * device.limits.double_operations);
}

double share(double seconds, const Speed& speed) { return 100 * seconds / speed.seconds; }

void print_device_speeds(const Results& results) {
  std::printf(
      "\nSpeed of the device, in millions of pairs of N^2 a second; kernel and copies, of the time of "
      "launches "
      "one by one; limits by operations (estimated), by its memory and by the copy to the host\n%-18s %8s "
      "%8s "
      "%9s %9s %8s %8s %9s %9s %9s %7s\n",
      "scene", "patches", "N", "tiles", "Mpairs/s", "kernel%", "copy%", "operat.", "memory", "copy",
      "x core");
  for (const Figures& row : results.figures) {
    const Ceilings ceilings = ceilings_of(row.work, results.device.limits);
    std::printf("%-18s %8zu %8zu %8.1f%% %9.0f %8.1f %8.1f %9.0f %9.0f %9.0f %7.0f\n", row.scene.c_str(),
                row.patches, row.elements,
                100 * static_cast<double>(row.device.traced) / static_cast<double>(row.device.tiles),
                1e-6 * row.device.pairs_per_second, share(row.by_launch.device.kernel, row.by_launch),
                share(row.by_launch.device.transfer, row.by_launch), 1e-6 * ceilings.operations,
                1e-6 * ceilings.memory, 1e-6 * ceilings.copy_to_host,
                row.device.pairs_per_second / row.host.pairs_per_second);
  }
  std::printf(
      "x core: against the same code on one core of the host, which is not how the program computes there\n");
  std::printf("\nTiles at once, %s\n%9s %9s %8s %8s\n", results.device.launch_scene.c_str(), "tiles",
              "Mpairs/s", "kernel%", "copy%");
  for (const LaunchFigures& row : results.device.launches)
    std::printf("%9zu %9.0f %8.1f %8.1f\n", row.tiles, 1e-6 * row.device.pairs_per_second,
                share(row.device.device.kernel, row.device), share(row.device.device.transfer, row.device));
}

void print_work(const std::vector<Figures>& figures) {
  std::printf(
      "\nWork of a pair, counted on the host: tests of boxes and patches against shafts, of boxes and "
      "patches "
      "against rays, in double precision; operations, estimated\n%-18s %8s %8s %9s %9s %9s %9s %9s %9s "
      "%10s\n",
      "scene", "patches", "N", "Mpairs/s*", "sh.boxes", "sh.patch", "boxes", "patches", "exact",
      "operations");
  for (const Figures& row : figures) {
    std::printf("%-18s %8zu %8zu %9.2f", row.scene.c_str(), row.patches, row.elements,
                1e-6 * row.host.pairs_per_second);
    for (const double times : row.work.times) std::printf(" %9.3g", times);
    std::printf(" %10.1f\n", row.work.single_operations + row.work.double_operations);
  }
  std::printf(
      "* pairs of N^2, by the same code on one core of the host, which is not how the program computes "
      "there\n");
}

std::string json_of(const Comparison& comparison) {
  return json::object({{"scene", json::text(comparison.scene)},
                       {"against", json::text(comparison.against)},
                       {"elements", json::number(static_cast<double>(comparison.elements))},
                       {"pairs", json::number(static_cast<double>(comparison.pairs))},
                       {"visible", json::number(static_cast<double>(comparison.visible))},
                       {"differing", json::number(static_cast<double>(comparison.differing))}});
}

std::string json_of(const Speed& speed) {
  return json::object({{"tiles", json::number(static_cast<double>(speed.tiles))},
                       {"traced_tiles", json::number(static_cast<double>(speed.traced))},
                       {"facing", json::number(static_cast<double>(speed.facing))},
                       {"seconds", json::number(speed.seconds)},
                       {"kernel_seconds", json::number(speed.device.kernel)},
                       {"transfer_seconds", json::number(speed.device.transfer)},
                       {"pairs_per_second", json::number(speed.pairs_per_second)}});
}

std::string json_of(const WorkOfPair& work) {
  return json::object({{kWorkNames[0], json::number(work.times[0])},
                       {kWorkNames[1], json::number(work.times[1])},
                       {kWorkNames[2], json::number(work.times[2])},
                       {kWorkNames[3], json::number(work.times[3])},
                       {kWorkNames[4], json::number(work.times[4])},
                       {"single_operations_estimated", json::number(work.single_operations)},
                       {"double_operations_estimated", json::number(work.double_operations)},
                       {"bytes", json::number(work.bytes)}});
}

std::string json_of(const Figures& figures, const DeviceFigures& device) {
  const Ceilings ceilings = ceilings_of(figures.work, device.limits);
  return json::object(
      {{"scene", json::text(figures.scene)},
       {"patches", json::number(static_cast<double>(figures.patches))},
       {"elements", json::number(static_cast<double>(figures.elements))},
       {"device", device.measured ? json_of(figures.device) : "null"},
       {"device_by_launch", device.measured ? json_of(figures.by_launch) : "null"},
       {"kernel_on_host_core", json_of(figures.host)},
       {"work_of_pair", json_of(figures.work)},
       {"most_pairs_per_second",
        !device.measured ? "null"
                         : json::object({{"operations_estimated", json::number(ceilings.operations)},
                                         {"memory", json::number(ceilings.memory)},
                                         {"copy_to_host", json::number(ceilings.copy_to_host)}})}});
}

std::string json_of(const DeviceFigures& device) {
  if (!device.measured) return json::object({{"why_not", json::text(device.why_not)}});
  std::vector<std::string> launches;
  for (const LaunchFigures& launch : device.launches)
    launches.push_back(json::object({{"tiles_at_once", json::number(static_cast<double>(launch.tiles))},
                                     {"device", json_of(launch.device)}}));
  return json::object(
      {{"name", json::text(device.properties.name)},
       {"compute_capability", json::number(device.properties.major + 0.1 * device.properties.minor)},
       {"multiprocessors", json::number(device.properties.multiprocessors)},
       {"memory_bytes", json::number(static_cast<double>(device.properties.memory))},
       {"copy_on_device_bytes_per_second", json::number(device.limits.copy_on_device)},
       {"copy_to_device_bytes_per_second", json::number(device.limits.copy_to_device)},
       {"copy_to_host_bytes_per_second", json::number(device.limits.copy_to_host)},
       {"single_operations_per_second_estimated", json::number(device.limits.single_operations)},
       {"double_operations_per_second_estimated", json::number(device.limits.double_operations)},
       {"launch_scene", json::text(device.launch_scene)},
       {"launches", json::list(launches)}});
}

}  // namespace

void print_comparison(const Comparison& comparison) {
  std::printf("%-18s against %-13s %8zu elements %12" PRIu64 " pairs %10" PRIu64 " see each other %8" PRIu64
              " differ\n",
              comparison.scene.c_str(), comparison.against.c_str(), comparison.elements, comparison.pairs,
              comparison.visible, comparison.differing);
  std::fflush(stdout);
}

void print_figures(const Results& results) {
  if (!results.figures.empty()) print_work(results.figures);
  print_hits(results.hits);
  print_paths(results.paths);
  print_octrees(results.octrees);
  if (!results.device.measured) {
    std::printf("\nNothing was run on a device: %s\n", results.device.why_not.c_str());
    return;
  }
  print_limits(results.device);
  print_device_speeds(results);
  print_rows(results.rows);
}

std::string to_json(const Results& results) {
  std::vector<std::string> comparisons, figures;
  for (const Comparison& comparison : results.comparisons) comparisons.push_back(json_of(comparison));
  for (const Figures& row : results.figures) figures.push_back(json_of(row, results.device));
  return json::object({{"device", json_of(results.device)},
                       {"comparisons", json::list(comparisons)},
                       {"figures", json::list(figures)},
                       {"hits", to_json(results.hits)},
                       {"paths", to_json(results.paths)},
                       {"octrees", to_json(results.octrees)},
                       {"rows", to_json(results.rows)}}) +
         "\n";
}

}  // namespace fluxel::cuda::checks

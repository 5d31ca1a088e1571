#include "app/viewfactors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/file.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/transfer.hpp"
#include "mpi_master/steps/view_factor_job.hpp"
#include "output/csv.hpp"

namespace fluxel {

namespace {

/// One line of the file.
struct ViewFactor {
  std::uint32_t from, to;
  double value, error;
};

/// Both directions of every exchange, in the order of the groups.
std::vector<ViewFactor> view_factors(const std::vector<GroupExchange>& exchanges,
                                     const std::vector<double>& areas) {
  std::vector<ViewFactor> factors;
  for (const auto& [from, to, exchange] : exchanges) {
    const double error = exchange.total_error();
    if (from == to) {
      // Every pair of the group's faces sends both ways inside it.
      factors.push_back({from, to, 2 * exchange.G / areas[from], 2 * error / areas[from]});
    } else {
      factors.push_back({from, to, exchange.G / areas[from], error / areas[from]});
      factors.push_back({to, from, exchange.G / areas[to], error / areas[to]});
    }
  }
  std::ranges::sort(factors, {}, [](const ViewFactor& f) { return std::pair(f.from, f.to); });
  return factors;
}

std::string csv(const Scene& scene, const std::vector<ViewFactor>& factors,
                const std::vector<double>& areas) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "from,to,area_from_m2,view_factor,error_estimate\n");
  std::vector<std::string> names;
  for (const std::string& group : scene.groups) names.push_back(csv_field(group));
  for (const ViewFactor& f : factors)
    fmt::format_to(std::back_inserter(text), "{},{},{:.12g},{:.12g},{:.2g}\n", names[f.from], names[f.to],
                   areas[f.from], f.value, f.error);
  return fmt::to_string(text);
}

struct Summary {
  double least = 0, mean = 0, most = 0;  ///< row sums, the mean weighted by area
  double reciprocity = 0;                ///< largest |A_i F_ij - A_j F_ji| over the larger of both
  double error = 0;                      ///< largest error estimate
};

Summary summarise(const std::vector<ViewFactor>& factors, const std::vector<double>& areas) {
  std::vector<double> sums(areas.size(), 0.0);
  Summary summary;
  for (const ViewFactor& f : factors) {
    sums[f.from] += f.value;
    summary.error = std::max(summary.error, f.error);
    const auto back = std::ranges::lower_bound(factors, std::pair(f.to, f.from), {},
                                               [](const ViewFactor& g) { return std::pair(g.from, g.to); });
    const double there = areas[f.from] * f.value, here = areas[f.to] * back->value;
    summary.reciprocity = std::max(summary.reciprocity, std::abs(there - here) / std::max(there, here));
  }
  summary.least = std::numeric_limits<double>::infinity();
  double area = 0;
  for (std::size_t group = 0; group < areas.size(); ++group) {
    if (areas[group] == 0) continue;
    summary.least = std::min(summary.least, sums[group]);
    summary.most = std::max(summary.most, sums[group]);
    summary.mean += areas[group] * sums[group];
    area += areas[group];
  }
  summary.mean /= area;
  return summary;
}

Scene load(const Communicator& world, const ViewFactorOptions& options, const SceneInput& input) {
  Scene scene;
  on_root(world, [&] {
    require_inputs_kept(input.files, std::array{std::filesystem::path(options.out)});
    const auto folder = std::filesystem::absolute(options.out).parent_path();
    require_writable_folder(folder);
    if (std::filesystem::is_directory(options.out))
      throw InputError(fmt::format("--out '{}' is a folder, not a file to write", options.out));
    SceneSettings settings{options.sides, KeMeaning::exitance, options.cut, std::nullopt};
    settings.merge = options.merge;
    scene = build_scene(input, settings);
  });
  broadcast(world, scene);
  return scene;
}

}  // namespace

int run_viewfactors(const Communicator& world, ViewFactorOptions options, const SceneInput& input,
                    ProgressDisplay& display) {
  const auto start = std::chrono::steady_clock::now();
  // 1. The root reads and checks; everybody gets the options and the scene.
  broadcast(world, options);
  const Scene scene = load(world, options, input);
  const std::vector<RankPlace> places = rank_places(world, options.threads);
  const int threads = places[static_cast<std::size_t>(world.rank())].threads;
  const bool talks = world.is_root() && !options.quiet;
  if (talks) {
    fmt::print("scene: {} patches in {} pieces, {} groups\n", scene.patches.size(), scene.pieces.size(),
               scene.groups.size());
    for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
  }

  // 2. All pairs of faces, a row of clusters at a time.
  const RayScene ray_scene(scene, threads);
  const FacePairs pairs(ray_scene, scene, options.tolerance);
  ProgressRecorder progress(display);
  const std::vector<GroupExchange> exchanges = exchange_of_groups(world, pairs, threads, progress);

  // 3. The file, and what can be checked without knowing better.
  const std::vector<double> areas = pairs.group_areas();
  on_root(world, [&] {
    const std::vector<ViewFactor> factors = view_factors(exchanges, areas);
    write_bytes_atomically(options.out, csv(scene, factors, areas));
    if (!talks) return;
    const Summary summary = summarise(factors, areas);
    std::uint64_t rays = 0;
    for (const GroupExchange& entry : exchanges) rays += entry.exchange.rays;
    fmt::print("view factors: {} of {} faces, {:.4g} rays, {:.2f} s\n", factors.size(), pairs.faces(),
               static_cast<double>(rays),
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    fmt::print("row sums: least {:.8g}, mean {:.8g}, largest {:.8g} (1 where a closed enclosure is seen)\n",
               summary.least, summary.mean, summary.most);
    fmt::print("reciprocity defect: {:.2g}; largest error estimate: {:.2g}\n", summary.reciprocity,
               summary.error);
    fmt::print("table: {}\n", options.out);
  });
  return 0;
}

}  // namespace fluxel

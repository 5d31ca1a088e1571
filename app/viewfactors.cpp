#include "app/viewfactors.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "app/run_log.hpp"
#include "core/file.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/transfer.hpp"
#include "mpi_master/steps/view_factor_job.hpp"
#include "output/view_factor_file.hpp"
#include "scene/doubtful_unit.hpp"

namespace fluxel {

namespace {

Scene load(const Communicator& world, const ViewFactorOptions& options, int threads,
           const SceneInput& input) {
  Scene scene;
  on_root(world, [&] {
    const std::filesystem::path folder = options.out;
    require_inputs_kept(input.files, std::array{folder / kViewFactorFile});
    if (folder.extension() == ".csv")
      throw InputError(fmt::format("--out '{}' is a folder for all output: the table in it is {}",
                                   options.out, kViewFactorFile));
    require_writable_folder(folder);
    SceneSettings settings{options.sides, KeMeaning::exitance, options.cut, std::nullopt};
    settings.merge = options.merge;
    settings.seal = false;  // what a closed body's inside sees is asked for too
    settings.threads = threads;
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
  const std::vector<RankPlace> places = rank_places(world, options.threads);
  const int threads = places[static_cast<std::size_t>(world.rank())].threads;
  const Scene scene = load(world, options, threads, input);
  if (world.is_root())
    if (const std::optional<std::string> doubt = doubt_of_unit(input))
      RunLog(world, options.quiet).warn(*doubt);
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
  const std::vector<SurfaceExchange> exchanges = exchange_of_surfaces(world, pairs, threads, progress);

  // 3. The file, and what can be checked of it.
  const std::vector<double> areas = pairs.surface_areas();
  on_root(world, [&] {
    const std::filesystem::path table = std::filesystem::path(options.out) / kViewFactorFile;
    const std::vector<SurfaceViewFactor> factors = view_factors_of(exchanges, areas);
    write_view_factors(table, scene, factors, areas);
    if (!talks) return;
    const ViewFactorChecks checks = check_view_factors(factors, areas);
    std::uint64_t rays = 0;
    for (const SurfaceExchange& entry : exchanges) rays += entry.exchange.rays;
    fmt::print("view factors: {} of {} faces, {:.4g} rays, {:.2f} s\n", factors.size(), pairs.faces(),
               static_cast<double>(rays),
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (!factors.empty())
      fmt::print("row sums: least {:.8g}, mean {:.8g}, largest {:.8g} (1 where a closed enclosure is seen)\n",
                 checks.min_row_sum, checks.mean_row_sum, checks.max_row_sum);
    if (checks.blind > 0) fmt::print("sides of groups that see nothing, and have no row: {}\n", checks.blind);
    fmt::print("reciprocity defect: {:.2g}; largest error estimate: {:.2g}\n", checks.reciprocity,
               checks.max_error);
    fmt::print("table: {}\n", table.string());
  });
  return 0;
}

}  // namespace fluxel

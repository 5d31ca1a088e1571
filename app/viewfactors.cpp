#include "app/viewfactors.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/run_log.hpp"
#include "core/file.hpp"
#include "core/options.hpp"
#include "formfactor/row_sum_check.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/transfer.hpp"
#include "mpi_master/steps/view_factor_job.hpp"
#include "output/face_factor_files.hpp"
#include "output/group_factor_files.hpp"
#include "output/view_factor_page.hpp"
#include "scene/readers/doubtful_unit.hpp"

namespace fluxel {

namespace {

Scene load_groups(const Communicator& world, const ViewFactorOptions& options, int threads,
                  const SceneInput& input) {
  Scene scene;
  on_root(world, [&] {
    const std::filesystem::path folder = options.out;
    std::vector<std::filesystem::path> outputs{folder / kViewFactorPage, folder / kFaceFile};
    for (const char* file : kGroupFactorFiles) outputs.push_back(folder / file);
    for (const FaceFactorFile& file : kFaceFactorFiles) outputs.push_back(folder / file.name);
    require_inputs_kept(input.files, outputs);
    if (folder.extension() == ".csv")
      throw InputError(fmt::format("--out '{}' is a folder for all output: the table in it is {}",
                                   options.out, kGroupFactorFiles[0]));
    require_writable_folder(folder);
    SceneSettings settings{options.sides, KeMeaning::exitance, options.cut, std::nullopt};
    settings.merge = options.merge;
    settings.specular = options.specular;
    settings.seal = false;  // what a closed body's inside sees is asked for too
    settings.threads = threads;
    scene = build_scene(input, settings);
  });
  broadcast(world, scene);
  return scene;
}

/// Exchanges between surfaces and the areas of these.
struct Surfaces {
  std::vector<SurfaceExchange> exchanges;
  std::vector<double> areas;  // [m2]

  [[nodiscard]] ExchangeTable table() const { return {exchanges, areas}; }
};

bool asks_for_faces(const ViewFactorOptions& options) {
  return std::ranges::any_of(options.write, [](const std::string& name) {
    return std::ranges::find(kFaceFactorFiles, name, &FaceFactorFile::asked) != kFaceFactorFiles.end();
  });
}

/// Says of which rows rays see something else; returns of how many.
std::uint64_t warn_of_rows(const RayScene& ray_scene, const ExchangeTable& of_groups, RunLog& log) {
  const std::vector<DoubtfulRow> doubtful = doubtful_rows(ray_scene, of_groups);
  if (doubtful.empty()) return 0;
  const DoubtfulRow& worst = *std::ranges::max_element(
      doubtful, {}, [](const DoubtfulRow& row) { return std::abs(row.sum - row.seen); });
  log.warn(fmt::format(
      "row sums of {} of {} surfaces are off by more than is stated: worst '{}' ({}), whose view factors add "
      "up to "
      "{:.4g} where {:.4g} of its rays meet surfaces",
      doubtful.size(), std::ranges::count_if(of_groups.areas, [](double area) { return area > 0; }),
      ray_scene.scene().groups[worst.surface / 2], worst.surface % 2 == 1 ? "back" : "front", worst.sum,
      worst.seen));
  return doubtful.size();
}

/// Writes all files; says where they are and what can be checked of them. Returns of how many surfaces the
/// row sums are in doubt.
std::uint64_t write_files(const ViewFactorOptions& options, const RayScene& ray_scene, const FacePairs& pairs,
                          SurfaceExchanges exchanges, int ranks, double seconds, RunLog& log) {
  const Scene& scene = ray_scene.scene();
  const std::filesystem::path folder = options.out;
  Surfaces groups{std::move(exchanges.list), pairs.surface_areas()}, faces;
  if (asks_for_faces(options)) {
    faces = std::move(groups);
    groups = {exchange_of_groups(scene, faces.exchanges), areas_of_groups(scene, faces.areas)};
  }
  const ViewFactorChecks checks = check_view_factors(groups.table());
  std::vector<std::string> of_groups = write_group_factors(folder, scene, groups.table(), options.write);
  write_view_factor_page(folder / kViewFactorPage, options, scene, groups.table(), checks, ranks);
  const std::vector<std::string> of_faces = write_face_factors(folder, scene, faces.table(), options.write);
  const std::uint64_t doubtful = warn_of_rows(ray_scene, groups.table(), log);
  if (options.quiet) return doubtful;
  const std::size_t count = count_view_factors(groups.exchanges);
  fmt::print("view factors: {} of {} faces, {:.4g} rays, {:.2f} s\n", count, pairs.faces(),
             static_cast<double>(exchanges.rays), seconds);
  if (count > 0)
    fmt::print("row sums: least {:.8g}, mean {:.8g}, largest {:.8g} (1 where a closed enclosure is seen)\n",
               checks.min_row_sum, checks.mean_row_sum, checks.max_row_sum);
  if (checks.blind > 0) fmt::print("sides of groups that see nothing, and have no row: {}\n", checks.blind);
  fmt::print("reciprocity defect: {:.2g}; largest error estimate: {:.2g}\n", checks.reciprocity,
             checks.max_error);
  for (const std::string& name : of_groups) fmt::print("table: {}\n", (folder / name).string());
  for (const std::string& name : of_faces) fmt::print("faces: {}\n", (folder / name).string());
  return doubtful;
}

}  // namespace

int run_viewfactors(const Communicator& world, ViewFactorOptions options, const SceneInput& input,
                    ProgressDisplay& display) {
  const auto start = std::chrono::steady_clock::now();
  // 1. The root reads and checks; everybody gets the options and the scene.
  broadcast(world, options);
  const std::vector<RankPlace> places = rank_places(world, options.threads);
  const int threads = places[static_cast<std::size_t>(world.rank())].threads;
  const Scene scene = load_groups(world, options, threads, input);
  RunLog log(world, options.quiet);
  if (world.is_root()) {
    if (const std::optional<std::string> doubt = doubt_of_unit(input)) log.warn(*doubt);
    for (const std::string& warning : scene.warnings) log.warn(warning);
  }
  const bool talks = world.is_root() && !options.quiet;
  if (talks) {
    fmt::print("scene: {} patches in {} pieces, {} groups\n", scene.patches.size(), scene.pieces.size(),
               scene.groups.size());
    for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
  }

  // 2. All pairs of faces, a row of clusters at a time.
  const RayScene ray_scene(scene, threads);
  const FacePairs pairs(ray_scene, scene, options.tolerance,
                        asks_for_faces(options) ? SurfacesOf::patches : SurfacesOf::groups);
  ProgressRecorder progress(display);
  SurfaceExchanges exchanges = exchange_of_surfaces(world, pairs, threads, progress);

  // 3. The files, and what can be checked of them.
  std::uint64_t doubtful = 0;
  on_root(world, [&] {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    tbb::task_arena arena(threads);
    arena.execute([&] {
      doubtful =
          write_files(options, ray_scene, pairs, std::move(exchanges), world.size(), taken.count(), log);
    });
  });
  world.all_sum(std::span(&doubtful, 1));
  return doubtful > 0 ? 3 : 0;
}

}  // namespace fluxel

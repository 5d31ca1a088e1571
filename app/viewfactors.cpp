#include "app/viewfactors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/run_log.hpp"
#include "core/file.hpp"
#include "core/options.hpp"
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

/// Writes all files; says where they are and what can be checked of them.
void write_files(const ViewFactorOptions& options, const Scene& scene, const FacePairs& pairs,
                 SurfaceExchanges exchanges, int ranks, double seconds) {
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
  if (options.quiet) return;
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
  if (world.is_root()) {
    RunLog log(world, options.quiet);
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
  on_root(world, [&] {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    write_files(options, scene, pairs, std::move(exchanges), world.size(), taken.count());
  });
  return 0;
}

}  // namespace fluxel

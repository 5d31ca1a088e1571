#include "app/viewfactors.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/run_log.hpp"
#include "core/file.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/transfer.hpp"
#include "mpi_master/steps/view_factor_job.hpp"
#include "output/face_factor_files.hpp"
#include "output/view_factor_file.hpp"
#include "output/view_factor_page.hpp"
#include "scene/doubtful_unit.hpp"

namespace fluxel {

namespace {

Scene load(const Communicator& world, const ViewFactorOptions& options, int threads,
           const SceneInput& input) {
  Scene scene;
  on_root(world, [&] {
    const std::filesystem::path folder = options.out;
    std::vector<std::filesystem::path> outputs{folder / kViewFactorFile, folder / kViewFactorPage,
                                               folder / kFaceFile};
    for (const FaceFactorFile& file : kFaceFactorFiles) outputs.push_back(folder / file.name);
    require_inputs_kept(input.files, outputs);
    if (folder.extension() == ".csv")
      throw InputError(fmt::format("--out '{}' is a folder for all output: the table in it is {}",
                                   options.out, kViewFactorFile));
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

struct GroupFactors {
  std::vector<SurfaceViewFactor> factors;
  std::vector<double> areas;  // [m2]
};

GroupFactors factors_of_groups(const Scene& scene, const FacePairs& pairs,
                               std::span<const SurfaceExchange> exchanges, bool by_patches) {
  std::vector<double> areas = pairs.surface_areas();
  if (!by_patches) return {view_factors_of(exchanges, areas), areas};
  areas = areas_of_groups(scene, areas);
  return {view_factors_of(exchange_of_groups(scene, exchanges), areas), areas};
}

/// Files of faces that are asked for; their names.
std::vector<std::string> write_faces(const std::filesystem::path& folder, const Scene& scene,
                                     const FacePairs& pairs, std::span<const SurfaceExchange> exchanges,
                                     std::span<const std::string> asked) {
  if (asked.empty()) return write_face_factors(folder, scene, {}, asked);
  const std::vector<double> areas = pairs.surface_areas();
  const std::vector<SurfaceViewFactor> factors = view_factors_of(exchanges, areas);
  return write_face_factors(folder, scene, {factors, areas}, asked);
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
  const bool by_patches = !options.write.empty();
  const FacePairs pairs(ray_scene, scene, options.tolerance,
                        by_patches ? SurfacesOf::patches : SurfacesOf::groups);
  ProgressRecorder progress(display);
  const std::vector<SurfaceExchange> exchanges = exchange_of_surfaces(world, pairs, threads, progress);

  // 3. The files, and what can be checked of them.
  on_root(world, [&] {
    const std::filesystem::path folder = options.out, table = folder / kViewFactorFile;
    const GroupFactors groups = factors_of_groups(scene, pairs, exchanges, by_patches);
    const auto& [factors, areas] = groups;
    write_view_factors(table, scene, factors, areas);
    write_view_factor_page(folder / kViewFactorPage, options, scene, factors, areas, world.size());
    const std::vector<std::string> of_faces = write_faces(folder, scene, pairs, exchanges, options.write);
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
    for (const std::string& name : of_faces) fmt::print("faces: {}\n", (folder / name).string());
  });
  return 0;
}

}  // namespace fluxel

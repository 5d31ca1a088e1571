#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <memory>
#include <string>
#include <utility>

#include "core/options.hpp"
#include "method/bake.hpp"
#include "method/element_audit.hpp"
#include "method/element_source.hpp"
#include "method/gathered_picture.hpp"
#include "method/kept_links.hpp"
#include "method/methods.hpp"
#include "method/receiver_light.hpp"
#include "method/say_devices.hpp"
#include "method/subdivide.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/host_gather.hpp"
#include "mpi_master/steps/ray_devices.hpp"
#include "subdivision/add_element.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/element_finder.hpp"
#include "subdivision/subdivide.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// Of the target's square, half is the solution's.
constexpr double kShareOfPicture = 0.7;

/// Single precision, and what the solution's own iteration leaves.
constexpr double kSameLight = 1e-3;

/// What falls on the unknowns, of which the file holds the radiosity.
std::vector<Rgb> irradiance_of(const Problem& problem, const Unknowns& unknowns, std::span<const Rgb> B) {
  double brightest = 0;
  for (const Rgb& value : B) brightest = std::max(brightest, mean_of_colours(glm::abs(value)));
  std::vector<Rgb> H(B.size(), Rgb(0));
  for (std::size_t k = 0; k < B.size(); ++k)
    for (int c = 0; c < kChannels; ++c) {
      const double reflected = B[k][c] - unknowns.E[k][c], rho = unknowns.rho[k][c];
      const double rounding = kSameLight * (std::abs(unknowns.E[k][c]) + 1e-3 * brightest);
      const bool is_dark = !(unknowns.area[k] > 0);
      if (!is_dark && ((rho == 0 && std::abs(reflected) > rounding) || reflected < -rounding))
        throw InputError(fmt::format(
            "{}: element {} has a radiosity of {:.4g} W/m2 where the scene's material emits {:.4g}: this is "
            "the light of other lights or materials; solve the scene as it is now",
            problem.options.solution, k % unknowns.elements, B[k][c], unknowns.E[k][c]));
      if (rho > 0) H[k][c] = reflected / rho;
    }
  return H;
}

/// Throws InputError where the file's elements and light are not all of the scene's.
void require_whole(const Problem& problem, const ElementView& mesh, const Unknowns& unknowns,
                   std::span<const Rgb> B) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}; give the solution.ply of a solve of the scene as it is now",
                                 problem.options.solution, what));
  };
  if (B.size() != unknowns.size())
    refuse(
        fmt::format("holds the radiosity of {} sides, and its elements have {}", B.size(), unknowns.size()));
  constexpr double kMissing = 0.01;  // what rounding leaves is far less
  double covered = 0;
  for (const Element& element : mesh.elements) covered += static_cast<double>(element.area);
  if (const double all = piece_area(problem.scene); covered < (1 - kMissing) * all)
    refuse(fmt::format("its elements cover {:.4g} m2 of the scene's {:.4g}", covered, all));
}

/// Throws InputError where more light is absorbed than is emitted, by more than a coarse solution is off.
void require_own_light(const Problem& problem, const Unknowns& unknowns, std::span<const Rgb> H) {
  constexpr double kMost = 1.5;
  Rgb emitted = LuminaireLight(problem.ray_scene).flux(), absorbed(0);
  for (std::size_t k = 0; k < H.size(); ++k) {
    emitted += unknowns.area[k] * unknowns.E[k];
    absorbed += unknowns.area[k] * (1.0 - unknowns.rho[k]) * H[k];
  }
  for (int c = 0; c < kChannels; ++c)
    if (absorbed[c] > kMost * emitted[c])
      throw InputError(
          fmt::format("{}: with the scene's reflectances {:.4g} W of a colour would be absorbed where {:.4g} "
                      "W are emitted: "
                      "this is the light of other lights or materials; solve the scene as it is now",
                      problem.options.solution, absorbed[c], emitted[c]));
}

/// A finished solution on this host.
struct FinishedLightOfMesh {
  SharedArray<Rgb> B, H;
};

/// Collective: elements of the file, as those of the run, and their light.
FinishedLightOfMesh take_up(const Problem& problem, SubdividedScene& subdivided) {
  ElementMesh mesh;
  FinishedSolution finished;
  on_root(problem.world, [&] {
    finished = problem.hooks.finished();
    for (const ElementShape& shape : finished.elements)
      add_element(problem.scene, shape.patch, shape.outline, mesh);
  });
  share_elements(problem.world, mesh, subdivided);
  std::vector<Rgb> H;
  on_root(problem.world, [&] {
    const Unknowns unknowns = make_unknowns(subdivided.mesh.elements, problem.scene.materials);
    require_whole(problem, subdivided.mesh, unknowns, finished.B);
    H = irradiance_of(problem, unknowns, finished.B);
    require_own_light(problem, unknowns, H);
  });
  // One part each, the root's.
  return {gather_on_hosts(problem.world, std::span<const Rgb>(finished.B)),
          gather_on_hosts(problem.world, std::span<const Rgb>(H))};
}

/// The element that each pixel sees.
void find_elements(const Problem& problem, SubdividedScene& subdivided) {
  const ElementFinder finder(subdivided.mesh);
  const Options& options = problem.options;
  Raster& raster = subdivided.raster;
  for (const SeenPoint& seen : seen_points(problem.scene, *options.camera, options.supersample, raster)) {
    const std::size_t element = finder.find(seen.patch, seen.point);
    raster.element[seen.pixel] =
        element == ElementFinder::kNone ? kNoElement : ElementId{static_cast<std::uint32_t>(element)};
  }
}

/// Collective: rays that have been traced, in rays of paths that take as long.
double work_of(const Problem& problem, const IrradianceSource& source) {
  constexpr double kGatherRay = 0.4;
  std::uint64_t rays = source.gather_rays();
  problem.world.all_sum(std::span(&rays, 1));
  return kGatherRay * static_cast<double>(rays);
}

/// Whether the gather or the solution is more of a picture's error, and what helps against that.
std::string cause_of_error(double stated, double gathered) {
  // Their squares add up.
  const double of_solution = std::sqrt(std::max(0.0, stated * stated - gathered * gathered));
  return fmt::format("{:.2g} % by the solution and {:.2g} % by how the picture is gathered; {}",
                     100 * of_solution, 100 * gathered,
                     of_solution >= gathered ? "solve with a smaller --target-error or larger --resolution"
                                             : "view with a smaller --target-error");
}

/// What the audit says of the target.
void judge(const Problem& problem, double target, Solution& solution) {
  const double stated = *solution.stated_error;
  solution.expected_error = stated;
  if (stated <= target) return;
  const Audit& audit = *solution.audit;
  const double gathered = solution.picture ? solution.picture->error.value_or(0) : 0;
  solution.goal_reached =
      solution.goal_reached && std::max({audit.known.least, audit.certain(), audit.likely_bias()}) <= target;
  problem.log.warn(
      fmt::format("the error stated is {:.2g} %, {} the target of {:.2g} %: {}", 100 * stated,
                  solution.goal_reached ? "which does not show whether it is below" : "above", 100 * target,
                  solution.goal_reached ? "give more --audit" : cause_of_error(stated, gathered)));
}

/// Collective: what GPUs have found, which has to be what processors find.
void finish_devices(const Problem& problem, const HitDevices& devices, Solution& solution) {
  if (devices.job.ranks == 0) return;
  const VerifiedCounts own = devices.own ? devices.own->counts() : VerifiedCounts{};
  solution.ray_devices =
      RayDeviceStatistics{devices.job.ranks, devices.job.names,
                          require_same(problem.world, own, "first hits of rays", kMostDifferingHits)};
  warn_of_device_failures(
      "picture", device_failures_of_all(problem.world, devices.own ? devices.own->failure() : std::string()),
      problem.log);
}

}  // namespace

Solution view_solution(const Problem& problem) {
  const Options& options = problem.options;
  Solution solution;

  // 1. The light of the elements, first, as a GPU or the file may be refused; and which of them the pixels
  // see.
  const HitDevices devices =
      gathers_picture(options) ? find_hit_devices(problem.world, options, problem.ray_scene) : HitDevices{};
  say_devices(devices.job, problem.world.size(), problem.log);
  SubdividedScene of_file;
  const FinishedLightOfMesh light = take_up(problem, of_file);
  if (options.camera) {
    subdivide(problem, {}, solution);
    of_file.raster = std::move(solution.subdivided.raster);
  }
  Stopwatch watch;
  solution.subdivided = std::move(of_file);
  const ElementView& mesh = solution.subdivided.mesh;
  if (options.camera) find_elements(problem, solution.subdivided);
  solution.radiosity.emplace();
  solution.converged = true;
  if (problem.world.is_root()) {
    solution.radiosity->B.assign(light.B.items().begin(), light.B.items().end());
    solution.radiosity->H.assign(light.H.items().begin(), light.H.items().end());
  }

  // 2. The light of each pixel.
  std::unique_ptr<IrradianceSource> kept;
  if (gathers_picture(options) || bakes(options)) kept = take_up_links(problem, light.B.items());
  const bool has_links = kept != nullptr;
  if (!has_links) kept = std::make_unique<ElementSource>(problem, mesh, light.H.items(), devices.own.get());
  if (has_links && devices.job.ranks > 0)
    problem.log.say("note: kept links have the light of the picture, so that GPUs have no part in it");
  IrradianceSource& source = *kept;
  const double target = options.target_error.value_or(kTargetError);
  if (gathers_picture(options)) {
    gather_picture(problem, source, kShareOfPicture * target, solution);
    const double error = solution.picture->error.value_or(0);
    solution.goal_reached = error <= target;
    if (!solution.goal_reached)
      problem.log.warn(
          fmt::format("gathering the picture alone leaves an error of {:.2g} %, above the target of {:.2g} %",
                      100 * error, 100 * target));
  }
  if (bakes(options)) bake(problem, source, target, solution);
  solution.time.gather = watch.lap();
  if (problem.sensors.has_meters()) gather_receivers(problem, mesh, light.H.items(), solution);
  watch.lap();

  // 3. How far it is off.
  if (options.camera && options.audit > 0) {
    AuditGoal goal = audit_goal(options, work_of(problem, source), target, std::nullopt);
    audit_elements(problem, {light.H.items(), solution.picture ? &source : nullptr}, goal, solution);
    if (solution.stated_error) judge(problem, target, solution);
    solution.time.audit = watch.lap();
  }
  if (!has_links) finish_devices(problem, devices, solution);
  solution.instruction_set = instruction_set_in_use();
  return solution;
}

}  // namespace fluxel

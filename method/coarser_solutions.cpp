#include "method/coarser_solutions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/options.hpp"
#include "method/handle_signals.hpp"
#include "method/matrix.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "solver/channels.hpp"
#include "solver/unknowns.hpp"
#include "subdivision/coarsen.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kCoarserMeshes = 2;

/// Of a mesh's elements, at most so many may be left in the next coarser one: else nearly all of them are
/// whole pieces, and it is not coarser in more than name.
constexpr double kMaxLeft = 0.9;

/// Of max |B - B*| over the area-mean of B: far below what is looked for, which is some tenths of a percent
/// where it is small.
constexpr double kCoarseTolerance = 1e-4;

/// Where nearly all light is reflected rounding leaves more, but no more than this root mean square, which
/// becomes a part of the estimate.
constexpr double kMostOfCoarse = 2e-3;

/// The run's options for a mesh that is `level` steps coarser.
Options coarse_options(const Options& of_run, int level) {
  Options options = of_run;
  // Errors grow with the elements, so that form factors may be found less well: the same share of them.
  options.form_factor.tolerance = std::ldexp(of_run.form_factor.tolerance, level);
  // What has been found shall not be lost because a GPU fails now.
  if (options.device == Device::cuda) options.device = Device::automatic;
  options.solver = Solver::automatic;
  options.tolerance = kCoarseTolerance;
  options.checkpoint.clear();
  options.reuse_visibility.clear();
  options.resume = options.preview = options.trace_every_pair = false;
  return options;
}

/// Coarser meshes, the finest first.
std::vector<CoarseMesh> make_coarser_meshes(const Problem& problem, const SubdividedScene& subdivided) {
  const ElementView& mesh = subdivided.mesh;
  Bytes levels(mesh.elements.size());
  if (problem.options.subdivision == Subdivision::camera) {
    if (problem.world.is_root()) levels = pixel_levels(subdivided.raster, mesh.elements.size());
    problem.world.broadcast(levels);
  }
  std::vector<CoarseMesh> meshes;
  while (meshes.size() < kCoarserMeshes) {
    const int k = static_cast<int>(meshes.size()) + 1;
    const std::span<const Element> finer =
        meshes.empty() ? mesh.elements : std::span<const Element>(meshes.back().mesh.elements);
    CoarseMesh coarse = coarsen(problem.scene, finer, meshes.empty() ? levels : meshes.back().pixel_levels, k,
                                std::ldexp(subdivided.max_edge, k));
    if (static_cast<double>(coarse.size()) > kMaxLeft * static_cast<double>(finer.size())) break;
    meshes.push_back(std::move(coarse));
  }
  return meshes;
}

/// Collective: the radiosity of a coarser mesh, on leaders.
CoarserSolution solve_coarse(const Problem& problem, const CoarseMesh& coarse, int level,
                             const CoarserSolution* coarser) {
  SilentProgress no_progress;
  SilentLog no_log;
  const Options options = coarse_options(problem.options, level);
  Problem own{problem.world, problem.scene,   problem.ray_scene, {},
              options,       problem.threads, no_progress,       no_log};
  if (coarser != nullptr && coarser->converged)
    own.hooks.start = [&](const ElementView&) { return on_parts(coarser->B, coarser->first); };
  SubdividedScene subdivided;
  subdivided.mesh = coarse.mesh;
  Solution solution;
  solve_mesh(own, subdivided, solution);
  CoarserSolution found{.first = coarse.first};
  // Rounding may end the iteration before the tolerance, near enough.
  // Leaders have it; all have to know.
  std::array<double, 1> good{
      solution.radiosity && largest_channel(solution.radiosity->mean_square_bound) <= kMostOfCoarse ? 1.0
                                                                                                    : 0.0};
  problem.world.all_max(good);
  found.converged = good[0] > 0;
  if (!found.converged || !solution.radiosity) return found;
  found.area = make_unknowns(coarse.mesh.elements, problem.scene.materials).area;
  found.B = std::move(solution.radiosity->B);
  found.H = std::move(solution.radiosity->H);
  found.error = solution.radiosity->mean_square_bound;
  return found;
}

}  // namespace

std::vector<Rgb> on_parts(std::span<const Rgb> values, std::span<const std::uint32_t> first) {
  std::vector<Rgb> parts;
  if (values.empty()) return parts;
  const std::size_t coarse = first.size() - 1;
  for (std::size_t unknown = 0; unknown < values.size(); ++unknown) {
    const std::size_t element = unknown % coarse;
    parts.insert(parts.end(), first[element + 1] - first[element], values[unknown]);
  }
  return parts;
}

CoarserSolutions solve_coarser_meshes(const Problem& problem, const SubdividedScene& subdivided) {
  const std::vector<CoarseMesh> meshes = make_coarser_meshes(problem, subdivided);
  CoarserSolutions found(meshes.size());
  for (std::size_t k = meshes.size(); k-- > 0;) {
    handle_signals(problem.world, problem.options, problem.log);
    found[k] = solve_coarse(problem, meshes[k], static_cast<int>(k) + 1,
                            k + 1 < meshes.size() ? &found[k + 1] : nullptr);
  }
  return found;
}

}  // namespace fluxel

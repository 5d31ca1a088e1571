#include "method/solve_scene.hpp"

#include "core/error.hpp"
#include "core/options.hpp"
#include "method/methods.hpp"
#include "mpi_master/communication/machine.hpp"

namespace fluxel {

namespace {

void check(const Options& options) {
  if (row_of(options.method).command != "solve")
    throw InputError("solve_scene knows the hierarchical and the matrix method alone");
  if (options.method == Method::matrix && options.subdivision == Subdivision::transport)
    throw InputError(
        "the matrix method needs elements: set Options::subdivision, and max_edge where it is uniform");
  if (options.subdivision == Subdivision::camera && !options.camera)
    throw InputError("Subdivision::camera needs Options::camera");
}

}  // namespace

Solution solve_scene(const Communicator& world, const Scene& scene, const Options& options, Log& log) {
  check(options);
  const int threads = rank_places(world, options.threads)[static_cast<std::size_t>(world.rank())].threads;
  const RayScene ray_scene(scene, threads);
  SilentProgress progress;
  const Problem problem{.world = world,
                        .scene = scene,
                        .ray_scene = ray_scene,
                        .sensors = sensors_of(options, scene),
                        .options = options,
                        .threads = threads,
                        .progress = progress,
                        .log = log};
  const MethodRow& method = row_of(options.method);
  Solution solution = method.solve(problem);
  if (method.estimate_error != nullptr) method.estimate_error(problem, solution);
  return solution;
}

}  // namespace fluxel

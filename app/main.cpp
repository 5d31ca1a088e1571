// mpirun -np 2 fluxel solve scenes/cornell-box/cornell-box.toml --out out
// mpirun -np 4 fluxel solve room.obj --eye 1,1.6,4 --look-at 1,1.5,0 --resolution 320x240 --sides one
// fluxel reference room.obj --elements out/solution.ply --target-error 0.01
// fluxel viewfactors room.obj --out factors.csv
// fluxel compare out/solution.ply reference/reference.ply --out errors
// fluxel solve room.obj --subdivision uniform --max-edge 0.1

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <variant>
#include <vector>

#include "app/command_line.hpp"
#include "app/compare.hpp"
#include "app/end_of_run.hpp"
#include "app/reference.hpp"
#include "app/solve.hpp"
#include "app/viewfactors.hpp"
#include "core/progress.hpp"
#include "core/signals.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/communicator.hpp"

namespace {

using namespace fluxel;

int run(const Communicator& world, const std::vector<std::string>& arguments) {
  const auto start = std::chrono::steady_clock::now();
  // 1. The root reads the command line and the scene's files.
  Request request;
  on_root(world, [&] { request = read_command_line(arguments); });
  if (world.is_root() && std::holds_alternative<TextRequest>(request))
    fmt::print("{}", std::get<TextRequest>(request).text);

  // 2. All ranks learn which job there is: 0 for none.
  std::uint64_t job = request.index();
  world.all_sum(std::span(&job, 1));
  if (job == 0) return 0;

  // 3. The job; what was read is on the root alone.
  NoDisplay silent;
  ConsoleDisplay console;
  const auto display = [&](bool quiet) -> ProgressDisplay& {
    return world.is_root() && !quiet ? static_cast<ProgressDisplay&>(console) : silent;
  };
  if (job == 1) {
    const SolveRequest solve = world.is_root() ? std::get<SolveRequest>(std::move(request)) : SolveRequest{};
    return run_solve(world, solve, display(solve.options.quiet), start);
  }
  if (job == 2) {
    const ReferenceRequest reference =
        world.is_root() ? std::get<ReferenceRequest>(std::move(request)) : ReferenceRequest{};
    return run_reference(world, reference, display(reference.options.run.quiet), start);
  }
  release_user_signals();  // there is nothing to keep
  if (job == 3) {
    const ViewFactorRequest factors =
        world.is_root() ? std::get<ViewFactorRequest>(std::move(request)) : ViewFactorRequest{};
    return run_viewfactors(world, factors.options, factors.input, display(factors.options.quiet));
  }
  return run_compare(world, world.is_root() ? std::get<CompareRequest>(request).options : CompareOptions{});
}

}  // namespace

int main(int argc, char** argv) {
  try {
    catch_user_signals();
    const MpiSession session(&argc, &argv);
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    return guarded(session.world(), [&] { return run(session.world(), arguments); });
  } catch (const std::exception& error) {
    fmt::print(stderr, "fluxel: {}\n", error.what());
    return 1;
  }
}

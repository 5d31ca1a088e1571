// mpirun -np 2 fluxel solve scenes/cornell-box/cornell-box.toml --out out
// mpirun -np 4 fluxel solve room.obj --eye 1,1.6,4 --look-at 1,1.5,0 --resolution 320x240 --sides one
// fluxel reference room.obj --elements out/solution.ply --target-error 0.01
// mpirun -np 2 fluxel photons room.toml --max-edge 0.1 --target-error 0.01
// fluxel viewfactors room.obj --out out/room
// fluxel info room.obj --metres-per-unit 0.001
// fluxel compare out/solution.ply reference/reference.ply --out errors
// fluxel solve room.obj --subdivision uniform --max-edge 0.1

#include <fmt/format.h>
#include <malloc.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/command_line.hpp"
#include "app/compare.hpp"
#include "app/end_of_run.hpp"
#include "app/info.hpp"
#include "app/photons.hpp"
#include "app/reference.hpp"
#include "app/solve.hpp"
#include "app/terminal.hpp"
#include "app/viewfactors.hpp"
#include "core/options.hpp"
#include "core/progress.hpp"
#include "core/signals.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/communication/launcher.hpp"

namespace {

using namespace fluxel;

template <class Job>
std::size_t index_of() {
  return Request(std::in_place_type<Job>).index();
}

/// The request where it was read; an empty one elsewhere.
template <class Job>
Job on_root_alone(const Communicator& world, Request& request) {
  return world.is_root() ? std::get<Job>(std::move(request)) : Job{};
}

int run(const Communicator& world, const std::vector<std::string>& arguments) {
  const auto start = std::chrono::steady_clock::now();
  // 1. The root reads the command line and the scene's files.
  Request request;
  on_root(world, [&] { request = read_command_line(arguments); });

  // 2. All ranks learn which job there is.
  std::uint64_t job = world.is_root() ? request.index() : 0;
  world.all_sum(std::span(&job, 1));

  // 3. The job; what was read is on the root alone.
  NoDisplay silent;
  ConsoleDisplay console;
  const auto display = [&](bool quiet) -> ProgressDisplay& {
    return world.is_root() && !quiet ? static_cast<ProgressDisplay&>(console) : silent;
  };
  if (job == index_of<SolveRequest>()) {
    auto solve = on_root_alone<SolveRequest>(world, request);
    ProgressDisplay& shown = display(solve.options.quiet);
    return run_solve(world, std::move(solve), shown, start);
  }
  if (job == index_of<ReferenceRequest>()) {
    const auto reference = on_root_alone<ReferenceRequest>(world, request);
    return run_reference(world, reference, display(reference.options.run.quiet), start);
  }
  if (job == index_of<PhotonsRequest>()) {
    const auto photons = on_root_alone<PhotonsRequest>(world, request);
    return run_photons(world, photons, display(photons.options.run.quiet), start);
  }
  release_user_signals();  // there is nothing to keep
  if (job == index_of<ViewFactorRequest>()) {
    const auto factors = on_root_alone<ViewFactorRequest>(world, request);
    return run_viewfactors(world, factors.options, factors.input, display(factors.options.quiet));
  }
  if (job == index_of<InfoRequest>()) {
    const auto info = on_root_alone<InfoRequest>(world, request);
    return run_info(world, info, silent);
  }
  return run_compare(world, on_root_alone<CompareRequest>(world, request).options);
}

/// Large arrays go back to the system when they are freed. By itself malloc keeps up to 64 MiB of such memory
/// for the next ones, on every rank; and told of the one limit alone, it gives back what is smaller each
/// time.
void give_back_large_arrays() {
  constexpr int kLarge = 4 << 20;
  mallopt(M_MMAP_THRESHOLD, kLarge);
  mallopt(M_TRIM_THRESHOLD, 4 * kLarge);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    give_back_large_arrays();
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (const std::optional<std::string> text = text_asked_for(arguments)) {
      if (rank_by_launcher().value_or(0) == 0) fmt::print("{}", *text);
      if (std::fflush(stdout) != 0) throw std::runtime_error("cannot write to standard output");
      return 0;
    }
    catch_user_signals();
    const MpiSession session(&argc, &argv);
    return guarded(session.world(), [&] { return run(session.world(), arguments); });
  } catch (const std::exception& error) {
    print_message(MessageKind::error, "fluxel", error.what());
    return 1;
  }
}

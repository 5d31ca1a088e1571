// mpirun -np 2 fluxel solve scenes/cornell-box/cornell-box.toml --out out
// mpirun -np 4 fluxel solve room.obj --eye 1,1.6,4 --look-at 1,1.5,0 --resolution 320x240 --sides one
// fluxel solve room.obj --subdivision uniform --max-edge 0.1

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <variant>
#include <vector>

#include "app/command_line.hpp"
#include "app/end_of_run.hpp"
#include "app/solve.hpp"
#include "core/progress.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/communicator.hpp"

namespace {

using namespace fluxel;

int run(const Communicator& world, const std::vector<std::string>& arguments) {
  const auto start = std::chrono::steady_clock::now();
  // 1. The root reads the command line and the scene's files.
  std::variant<TextRequest, SolveRequest> request;
  on_root(world, [&] { request = read_command_line(arguments); });
  if (world.is_root() && std::holds_alternative<TextRequest>(request))
    fmt::print("{}", std::get<TextRequest>(request).text);

  // 2. All ranks learn whether there is work at all.
  std::uint64_t work = std::holds_alternative<SolveRequest>(request) ? 1 : 0;
  world.all_sum(std::span(&work, 1));
  if (work == 0) return 0;

  // 3. The job.
  const SolveRequest solve = world.is_root() ? std::get<SolveRequest>(std::move(request)) : SolveRequest{};
  SilentProgress silent;
  ConsoleProgress console;
  const bool shown = world.is_root() && !solve.options.quiet;
  return run_solve(world, solve, shown ? static_cast<Progress&>(console) : silent, start);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const MpiSession session(&argc, &argv);
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    return guarded(session.world(), [&] { return run(session.world(), arguments); });
  } catch (const std::exception& error) {
    fmt::print(stderr, "fluxel: {}\n", error.what());
    return 1;
  }
}

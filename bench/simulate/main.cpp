// simulate_bench trace --scene room-of-180-boxes --elements 1000000 --out room-1m.traced
// mpirun -np 2 --bind-to none simulate_bench machine --out machine.json
// simulate_bench scaling room-100k.traced room-1m.traced --machine machine.json --out scaling.csv
// simulate_bench weak room-62k.traced room-125k.traced room-250k.traced --machine machine.json --out weak.csv
// simulate_bench slow room-1m.traced --machine machine.json --out slow.csv
// simulate_bench tasks office.traced --machine machine.json --out tasks.csv
// simulate_bench predict office.traced --machine machine.json --out predicted.csv

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <numeric>
#include <thread>

#include "bench/simulate/scenarios.hpp"
#include "bench/simulate/trace_scene.hpp"
#include "core/error.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "visibility/tile_store.hpp"

namespace {

using namespace fluxel;
using namespace fluxel::bench;

struct Request {
  TraceSettings trace;
  std::string machine, out, product_of;
  double product_seconds = 0;
  std::size_t unknowns = 1'000'000;
  std::vector<std::string> scenes;
  std::vector<int> ranks;
  double pairs_a_rank = 4.9e8;  // a million elements on 1024 ranks
  int cores = static_cast<int>(std::thread::hardware_concurrency());
};

CLI::App* add_trace(CLI::App& app, Request& request) {
  CLI::App* trace = app.add_subcommand("trace", "measures the tiles of a scene, on one thread");
  trace->add_option("--scene", request.trace.scene)->capture_default_str();
  trace
      ->add_option("--scenes", request.trace.large_scenes, "folder of scenes that the project does not bring")
      ->envname("FLUXEL_SCENES");
  trace->add_option("--elements", request.trace.elements, "about so many")->capture_default_str();
  trace->add_option("--blocks", request.trace.blocks, "on the side of the matrix")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  trace->add_option("--tiles", request.trace.tiles_per_block, "traced of each block")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  trace->add_option("--out", request.out, "file to write")->required();
  return trace;
}

CLI::App* add_machine(CLI::App& app, Request& request) {
  CLI::App* machine = app.add_subcommand("machine", "measures messages and vectors; under mpirun -np 2");
  machine
      ->add_option("--product-seconds", request.product_seconds,
                   "of one iteration of a real solve on one thread")
      ->required();
  machine->add_option("--product-of", request.product_of, "the traced scene of that solve")->required();
  machine->add_option("--unknowns", request.unknowns, "of the vectors")->capture_default_str();
  machine->add_option("--out", request.out, "JSON")->required();
  return machine;
}

CLI::App* add_run(CLI::App& app, Request& request, const char* name, const char* what) {
  CLI::App* run = app.add_subcommand(name, what);
  run->add_option("traced", request.scenes, "files of `trace`")->required();
  run->add_option("--machine", request.machine, "file of `machine`")->required();
  run->add_option("--ranks", request.ranks, "numbers of ranks")->delimiter(',')->check(CLI::PositiveNumber);
  run->add_option("--pairs", request.pairs_a_rank, "weak: of elements, a rank")->capture_default_str();
  run->add_option("--cores", request.cores, "predict: that the ranks share")->capture_default_str();
  run->add_option("--out", request.out, "CSV")->required();
  return run;
}

std::vector<TracedScene> read_scenes(const Request& request) {
  std::vector<TracedScene> scenes;
  for (const std::string& file : request.scenes) scenes.push_back(read_traced_scene(file));
  return scenes;
}

std::vector<int> ranks_or(const Request& request, std::vector<int> usual) {
  return request.ranks.empty() ? usual : request.ranks;
}

void measure_machine(const Communicator& world, const Request& request) {
  if (world.size() < 2) throw InputError("machine: messages need two ranks (mpirun -np 2)");
  MachineFigures figures{measure_messages(world), {}};
  if (!world.is_root()) return;
  const std::vector<double> work = product_work(read_traced_scene(request.product_of).map);
  figures.solve = {request.product_seconds / std::accumulate(work.begin(), work.end(), 0.0),
                   measure_vectors(request.unknowns)};
  write_machine(request.out, figures);
}

/// What a rank holds for each element beside its tiles, by the forecast's formula.
double vector_bytes(const Communicator& alone) {
  constexpr std::size_t kElements = 1'000'000;
  const std::size_t tiles = tile_count(kElements);
  return static_cast<double>(least_bytes(alone, kElements) - TileStore::bytes_for(tiles, {0, tiles}, 0)) /
         kElements;
}

}  // namespace

int main(int argc, char** argv) {
  const MpiSession session(&argc, &argv);
  CLI::App app("Simulates the visibility phase and the solve on many ranks.");
  app.require_subcommand(1);
  Request request;
  CLI::App* trace = add_trace(app, request);
  CLI::App* machine = add_machine(app, request);
  CLI::App* scaling = add_run(app, request, "scaling", "visibility and solve on many ranks");
  CLI::App* weak = add_run(app, request, "weak", "scenes of growing size on as many ranks as they need");
  CLI::App* slow = add_run(app, request, "slow", "ranks of different speed");
  CLI::App* tasks = add_run(app, request, "tasks", "strips against pairs of patches");
  CLI::App* predict = add_run(app, request, "predict", "runs on this machine, to compare with real ones");
  CLI11_PARSE(app, argc, argv);

  try {
    const Communicator& world = session.world();
    if (*trace) write_traced_scene(request.out, trace_scene(world, request.trace));
    if (*machine) measure_machine(world, request);
    if (*scaling)
      run_scaling(read_scenes(request), read_machine(request.machine),
                  ranks_or(request, {16, 64, 256, 1024, 4096}), vector_bytes(world), request.out);
    if (*weak)
      run_weak_scaling(read_scenes(request), read_machine(request.machine), request.pairs_a_rank,
                       vector_bytes(world), request.out);
    if (*slow)
      run_slow_ranks(read_scenes(request), read_machine(request.machine), ranks_or(request, {16, 256, 1024}),
                     request.out);
    if (*tasks)
      run_tasks(read_scenes(request), read_machine(request.machine),
                ranks_or(request, {2, 3, 4, 5, 6, 7, 8, 9, 10, 64}), request.out);
    if (*predict)
      run_prediction(read_scenes(request), read_machine(request.machine), ranks_or(request, {1, 2, 3, 4}),
                     request.cores, request.out);
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "simulate_bench: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "simulate_bench: {}\n", error.what());
    return 1;
  }
}

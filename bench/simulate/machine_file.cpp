#include "bench/simulate/machine_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"

namespace fluxel::bench {

namespace {

constexpr int kRanksPerHost = 32;
constexpr Channel kSharedMemory{0.5e-6, 10e9};  // of a cluster's host
constexpr double kTimerSlack = 55e-6;           // of Linux: 50 us by default, and the way back

/// Names in the file, and where the numbers go.
template <class Figures, class Visit>
void visit_numbers(Figures& figures, const Visit& visit) {
  visit("send_s", figures.messages.costs.send);
  visit("receive_s", figures.messages.costs.receive);
  visit("tile_out_s", figures.messages.costs.tile_out);
  visit("tile_in_s", figures.messages.costs.tile_in);
  visit("latency_s", figures.messages.within_host.latency);
  visit("bytes_per_second", figures.messages.within_host.bytes_per_second);
  visit("lit_tile_s", figures.solve.lit_tile);
  visit("unknown_s", figures.solve.unknown);
}

JobSettings on_hosts(const MachineFigures& figures, const Network& network, int ranks) {
  JobSettings settings{network, figures.messages.costs, true, kTimerSlack, {}};
  settings.speed.assign(static_cast<std::size_t>(ranks), 1.0);
  return settings;
}

}  // namespace

void write_machine(const std::string& file, const MachineFigures& figures) {
  nlohmann::ordered_json json;
  visit_numbers(figures, [&](const char* name, double value) { json[name] = value; });
  std::ofstream out(file);
  out << json.dump(2) << "\n";
  if (!out.flush()) throw InputError(fmt::format("{} cannot be written", file));
}

MachineFigures read_machine(const std::string& file) {
  std::ifstream in(file);
  MachineFigures figures;
  try {
    const auto json = nlohmann::json::parse(in);
    visit_numbers(figures, [&](const char* name, double& value) { value = json.at(name).get<double>(); });
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{} is no file of `simulate machine` ({})", file, error.what()));
  }
  return figures;
}

JobSettings on_this_machine(const MachineFigures& figures, int ranks, int cores) {
  JobSettings settings =
      on_hosts(figures, {"this machine", {}, figures.messages.within_host, 0, ranks}, ranks);
  // Ranks that share cores share them evenly as long as all have work.
  for (double& speed : settings.speed) speed = std::min(1.0, static_cast<double>(cores) / ranks);
  return settings;
}

JobSettings on_infiniband(const MachineFigures& figures, int ranks) {
  return on_hosts(figures, {"InfiniBand", {1.5e-6, 12e9}, kSharedMemory, 1e-8, kRanksPerHost}, ranks);
}

JobSettings on_ethernet(const MachineFigures& figures, int ranks) {
  constexpr double kSocketCall = 3e-6;  // system call and copy, beside MPI's own time
  JobSettings settings =
      on_hosts(figures, {"Ethernet", {25e-6, 1e9}, kSharedMemory, 1e-6, kRanksPerHost}, ranks);
  settings.costs.send += kSocketCall;
  settings.costs.receive += kSocketCall;
  return settings;
}

}  // namespace fluxel::bench

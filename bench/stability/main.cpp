// stability_lab --out lab.csv
// stability_lab --situation furnace --coarse --out furnace.csv

#include <fmt/format.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "bench/stability/lab.hpp"

namespace {

using namespace fluxel;

void run_situation(const Communicator& world, const lab::Situation& situation, bool coarse,
                   fmt::ostream& table) {
  for (const lab::Method& method : lab::methods()) {
    const auto start = std::chrono::steady_clock::now();
    for (const double value : coarse ? situation.coarse_values : situation.values) {
      const lab::Measurement found = situation.measure(world, method, value);
      table.print("{},\"{}\",\"{}\",\"{}\",{:g},{},\"{}\",{:g},{:.4e},{}\n", situation.name, situation.title,
                  situation.parameter, situation.error, situation.threshold, situation.log_parameter ? 1 : 0,
                  method.name, value, found.error, found.converged ? 1 : 0);
      table.flush();
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    fmt::print("{:24} {:24} {:8.1f} s\n", situation.name, method.name, taken.count());
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs every method over the situations in which methods fail.");
  std::string wanted, out;
  bool coarse = false;
  app.add_option("--situation", wanted, "this one alone");
  app.add_flag("--coarse", coarse, "few values of each parameter");
  app.add_option("--out", out, "CSV, a line a measurement")->required();
  CLI11_PARSE(app, argc, argv);

  const MpiSession session(&argc, &argv);
  fmt::ostream table = fmt::output_file(out);
  table.print("situation,title,parameter,error_label,threshold,log_parameter,method,value,error,converged\n");
  bool found = false;
  for (const lab::Situation& situation : lab::situations()) {
    if (!wanted.empty() && situation.name != wanted) continue;
    run_situation(session.world(), situation, coarse, table);
    found = true;
  }
  if (!found) fmt::print(stderr, "no situation is named {}\n", wanted);
  return found ? 0 : 2;
}

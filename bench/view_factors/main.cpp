// view_factors_bench known --out known.csv
// view_factors_bench known --only BS --tolerances 1e-2,1e-3
// view_factors_bench cubes --divisions 10 --out cubes.csv

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "bench/view_factors/tables.hpp"
#include "core/error.hpp"

namespace {

void add_table_options(CLI::App& command, std::vector<double>& tolerances, std::string& csv) {
  command.add_option("--tolerances", tolerances, "as --tolerance of fluxel viewfactors")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command.add_option("--out", csv, "CSV");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures view factors of groups, on one thread, in processor time.");
  app.require_subcommand(1);
  std::string only, csv;
  std::vector<double> known_tolerances{1e-3, 1e-5}, cubes_tolerances{1e-2, 1e-3, 4e-4};
  double slow = 2;
  int divisions = 10;

  CLI::App* known = app.add_subcommand("known", "errors over view factors known in closed form");
  add_table_options(*known, known_tolerances, csv);
  known->add_option("--only", only, "this case alone");
  known
      ->add_option("--slow", slow, "a case that takes longer is not asked for the tolerances that follow [s]")
      ->capture_default_str();

  CLI::App* cubes = app.add_subcommand("cubes", "time and row sums of a cube in a cube");
  add_table_options(*cubes, cubes_tolerances, csv);
  cubes->add_option("--divisions", divisions, "each wall in so many squares squared, each a group")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);

  try {
    if (*known) fluxel::bench::print_known_factors(known_tolerances, slow, only, csv);
    if (*cubes) fluxel::bench::print_nested_cubes(cubes_tolerances, divisions, csv);
    return 0;
  } catch (const fluxel::InputError& error) {
    fmt::print(stderr, "view_factors_bench: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "view_factors_bench: {}\n", error.what());
    return 1;
  }
}

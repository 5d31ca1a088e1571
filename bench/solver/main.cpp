// solver_bench kernel --out kernel.csv
// solver_bench rows --out rows.csv
// solver_bench operator --scenes FOLDER --out operator.csv
// solver_bench methods --out methods.csv

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "bench/solver/kernel_rates.hpp"
#include "bench/solver/methods.hpp"
#include "bench/solver/operator_rates.hpp"
#include "bench/solver/row_accuracy.hpp"
#include "core/error.hpp"

int main(int argc, char** argv) {
  using namespace fluxel;
  using namespace fluxel::bench;
  CLI::App app("Measures the solvers and their row kernel.");
  app.require_subcommand(1);
  KernelSettings kernel_settings;
  AccuracySettings accuracy_settings;
  OperatorSettings operator_settings;
  MethodSettings method_settings;
  const auto add_repetitions = [](CLI::App& command, int& repetitions) {
    command.add_option("--repeat", repetitions, "take the median of so many")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
  };

  CLI::App* kernel = app.add_subcommand("kernel", "pairs a second, for each instruction set and rule");
  kernel->add_option("--out", kernel_settings.csv, "CSV")->required();
  kernel->add_option("--elements", kernel_settings.elements, "columns")->capture_default_str();
  kernel->add_option("--rows", kernel_settings.rows, "rows that are timed")->capture_default_str();
  add_repetitions(*kernel, kernel_settings.repetitions);

  CLI::App* rows = app.add_subcommand("rows", "digits of rows, against double precision");
  rows->add_option("--out", accuracy_settings.csv, "CSV")->required();
  rows->add_option("--along", accuracy_settings.along, "elements along a face's edge")->capture_default_str();
  rows->add_option("--rows", accuracy_settings.rows, "rows")->capture_default_str();

  CLI::App* whole = app.add_subcommand("operator", "pairs of N^2 a second with a scene's tiles");
  whole->add_option("--out", operator_settings.csv, "CSV")->required();
  whole->add_option("--elements", operator_settings.elements, "number of elements")->capture_default_str();
  whole
      ->add_option("--scenes", operator_settings.large_scenes,
                   "folder of scenes that the project does not bring")
      ->envname("FLUXEL_SCENES");
  whole->add_option("--only", operator_settings.only, "this scene alone");
  add_repetitions(*whole, operator_settings.repetitions);

  CLI::App* methods = app.add_subcommand("methods", "iterations and seconds of the solvers");
  methods->add_option("--out", method_settings.csv, "CSV")->required();
  methods->add_option("--elements", method_settings.elements, "number of elements")->capture_default_str();
  methods->add_option("--only", method_settings.only, "this room alone: box, cluttered or two-rooms");
  methods->add_option("--limit", method_settings.limit_seconds, "give a solve up after so many seconds")
      ->capture_default_str();
  add_repetitions(*methods, method_settings.repetitions);
  CLI11_PARSE(app, argc, argv);

  try {
    if (*kernel) run_kernel(kernel_settings);
    if (*rows) run_rows(accuracy_settings);
    if (*whole) run_operator(operator_settings);
    if (*methods) run_methods(method_settings);
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "solver_bench: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "solver_bench: {}\n", error.what());
    return 1;
  }
}

#include <CLI/CLI.hpp>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"

namespace fluxel {

void declare_compare(CLI::App* compare, CompareOptions& of) {
  compare
      ->add_option(
          "A", of.judged,
          "what is judged: a file of elements (solution.ply, reference.ply), a picture or a receiver (.exr)")
      ->required();
  compare->add_option("B", of.reference, "what it is judged against, of the same elements or pixels")
      ->required();
  compare
      ->add_option(
          "--out", of.out,
          "folder for compare.json, histogram.csv and the map of the error (default: none is written)")
      ->check(refuse_empty)
      ->type_name("DIR");
  add_parsed(
      compare, "fail-above", [&of](const std::string& t) { of.fail_above = parse_number(t); },
      "end with 3 where the error is above: sigma over the mean of B, without B's noise where B states it",
      "E");
  compare->add_flag("--quiet", of.quiet, "print warnings and errors only");
}

}  // namespace fluxel

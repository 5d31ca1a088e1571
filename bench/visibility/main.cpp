// visibility_bench visibility --out visibility.csv --scenes FOLDER
// visibility_bench visibility --only room-of-180-boxes --sizes 24576 --out room.csv
// visibility_bench subdivision --out subdivision.csv
// visibility_bench trace room-of-12-boxes --size 1000

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "bench/visibility/runs.hpp"
#include "core/error.hpp"

namespace {

using namespace fluxel;
using namespace fluxel::bench;

void add_scene_options(CLI::App& command, Choice& choice) {
  command
      .add_option("--scenes", choice.large_scenes,
                  "folder of scenes that the project does not bring: room-12.obj, room-180.obj, "
                  "modern-hall.obj, wooden-staircase.obj")
      ->envname("FLUXEL_SCENES");
  command.add_flag("--triangles", choice.triangles, "cut all polygons into triangles first");
}

void add_table_options(CLI::App& command, Choice& choice, std::string& csv, int& repetitions) {
  add_scene_options(command, choice);
  command.add_option("--out", csv, "CSV")->required();
  command.add_option("--only", choice.only, "this scene alone");
  command.add_option("--repeat", repetitions, "take the median of so many")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Measures the visibility engine, one thread.");
  app.require_subcommand(1);
  Choice choice;
  MeasureSettings settings;
  std::string csv;
  std::vector<std::size_t> sizes{1000, 2000, 4000, 8000, 16000, 24576, 50000, 100000};
  std::vector<int> resolutions{64, 128, 256, 512, 1024, 2048};
  std::size_t size = 1000;

  CLI::App* visibility = app.add_subcommand("visibility", "speed and memory against the number of elements");
  add_table_options(*visibility, choice, csv, settings.repetitions);
  visibility->add_option("--sizes", sizes, "numbers of elements")->delimiter(',')->capture_default_str();
  visibility
      ->add_option("--most-tiles", settings.most_tiles,
                   "where there are more, trace so many by chance and scale up")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  visibility->add_option("--sample", settings.sample_tiles, "tiles for the raw rate and the classical method")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  visibility->add_flag("!--no-classical", settings.classical, "leave out the classical method");

  CLI::App* subdivision = app.add_subcommand("subdivision", "time of camera subdivision against resolution");
  add_table_options(*subdivision, choice, csv, settings.repetitions);
  subdivision->add_option("--resolutions", resolutions, "pixels a side")
      ->delimiter(',')
      ->capture_default_str();

  CLI::App* trace = app.add_subcommand("trace", "the engine alone, once, for a profiler");
  add_scene_options(*trace, choice);
  trace->add_option("scene", choice.only, "its name")->required();
  trace->add_option("--size", size, "number of elements")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  try {
    if (*visibility) run_visibility(choice, sizes, settings, csv);
    if (*subdivision) run_subdivision(choice, resolutions, settings.repetitions, csv);
    if (*trace) run_trace(choice, size);
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "visibility_bench: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "visibility_bench: {}\n", error.what());
    return 1;
  }
}

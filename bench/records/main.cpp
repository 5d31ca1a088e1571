// records_bench scenes/cornell-box/cornell-box.toml --resolution 128x128
//
// Records that pictures take: those of gather_sparsely beside those of a lazy cache on one thread (Ward,
// Rubinstein & Clear 1988, with gradients) at the same true error.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/options.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "tests/ward_cache/record_counts.hpp"

namespace {

using namespace fluxel;
using namespace fluxel::ward_cache;

struct Series {
  std::vector<double> acceptances{0.8, 0.6, 0.45, 0.35, 0.27, 0.2, 0.15, 0.11, 0.08};
  std::vector<double> least_pixels{1, 2, 3, 5};
  std::vector<double> allowed{0.04, 0.02, 0.01, 0.007, 0.005, 0.0035};
};

void compare(GatheredRoom& room, const Series& series) {
  fmt::print("A record at each pixel: {:.3f} %\n\n", 100 * room.error_of(room.records()));
  LazyPainter painter(room);
  std::vector<std::vector<RecordCount>> lazy;
  fmt::print("| lazy cache, least reach in pixels | a | records | error |\n| ---: | ---: | ---: | ---: |\n");
  for (const bool limits : {true, false})
    for (const double least : series.least_pixels) {
      lazy.push_back(count_lazily(room, painter, series.acceptances, {0, least, limits}));
      for (std::size_t k = 0; k < series.acceptances.size(); ++k)
        fmt::print("| {}{:g} | {:g} | {:.0f} | {:.3f} % |\n", limits ? "limited, " : "", least,
                   series.acceptances[k], lazy.back()[k].records, 100 * lazy.back()[k].error);
    }
  fmt::print("\n| allowed | error | records | lazy cache | ratio |\n| ---: | ---: | ---: | ---: | ---: |\n");
  for (const double allowed : series.allowed) {
    const RecordCount own = count_sparsely(room, allowed);
    fmt::print("| {:.2f} % | {:.3f} % | {:.0f} |", 100 * allowed, 100 * own.error, own.records);
    std::optional<double> fewest;
    for (const std::vector<RecordCount>& counts : lazy)
      if (const auto found = records_at(own.error, counts); found && (!fewest || *found < *fewest))
        fewest = found;
    if (fewest)
      fmt::print(" {:.0f} | {:.2f} |\n", *fewest, own.records / *fewest);
    else
      fmt::print(" | |\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares numbers of records at equal error.");
  std::string scene, resolution = "128x128";
  double ray_error = 1e-4, finer = 4;
  Series series;
  app.add_option("scene", scene)->required();
  app.add_option("--resolution", resolution, "of the picture")->capture_default_str();
  app.add_option("--ray-error", ray_error, "of records")->capture_default_str();
  app.add_option("--finer", finer, "rays' error of the truth, over that")->capture_default_str();
  app.add_option("--a", series.acceptances, "of the lazy cache")->delimiter(',')->capture_default_str();
  app.add_option("--least-pixels", series.least_pixels, "that its records reach")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--allowed", series.allowed, "errors")->delimiter(',')->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    const MpiSession session(&argc, &argv);
    const auto request =
        std::get<SolveRequest>(read_command_line({"solve", scene, "--resolution", resolution}));
    GatheredRoom room(session.world(), request, ray_error, finer);
    compare(room, series);
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "records_bench: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "records_bench: {}\n", error.what());
    return 1;
  }
}

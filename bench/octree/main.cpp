// octree_bench modern-hall.obj > octree.md
//
// How fast the octree of references finds the spheres that hold a point, beside a k-d tree (nanoflann), a
// hashed grid and all of them one by one, whose answers it compares.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/command_line.hpp"
#include "bench/octree/look_ups.hpp"
#include "bench/octree/spheres.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "scene/scene_input.hpp"

namespace {

using namespace fluxel;
using namespace fluxel::bench;

constexpr double kOverlap = 10;
constexpr std::size_t kQueries = 1'000'000;
constexpr int kTurns = 5;

Scene load(const std::string& file) {
  auto request = std::get<SolveRequest>(read_command_line({"solve", file}));
  return build_scene(request.input, {Sides::one, KeMeaning::radiance, false, std::nullopt});
}

struct Timed {
  double nanoseconds = 0;  ///< a query, median of the turns
  std::uint64_t checksum = 0;
};

/// In turns, so that none has the quiet moments.
std::vector<Timed> time_queries(const std::vector<std::unique_ptr<LookUp>>& ways,
                                std::span<const glm::dvec3> points) {
  std::vector<std::vector<double>> seconds(ways.size());
  std::vector<Timed> timed(ways.size());
  for (int turn = 0; turn < kTurns; ++turn)
    for (std::size_t way = 0; way < ways.size(); ++way) {
      std::uint64_t checksum = 0;
      seconds[way].push_back(seconds_of([&] {
        for (const glm::dvec3& point : points) {
          const Held held = ways[way]->at(point);
          checksum += held.count + held.sum;
        }
      }));
      timed[way].checksum = checksum;
    }
  for (std::size_t way = 0; way < ways.size(); ++way)
    timed[way].nanoseconds = 1e9 * median(seconds[way]) / static_cast<double>(points.size());
  return timed;
}

/// The median of builds by one thread and by two, in turns [s].
std::pair<double, double> time_builds(std::span<const Sphere> spheres) {
  std::vector<double> one, two;
  for (int turn = 0; turn < kTurns; ++turn) {
    one.push_back(seconds_of([&] { static_cast<void>(by_octree(spheres, 1)); }));
    two.push_back(seconds_of([&] { static_cast<void>(by_octree(spheres, 2)); }));
  }
  return {median(one), median(two)};
}

/// The number of points of which brute force finds others.
std::size_t count_differences(const LookUp& look_up, std::span<const Sphere> spheres,
                              std::span<const glm::dvec3> points) {
  std::size_t different = 0;
  for (const glm::dvec3& point : points)
    different += look_up.at(point) == by_brute_force(spheres, point) ? 0 : 1;
  return different;
}

int run(const std::string& file) {
  const Scene scene = load(file);
  {
    constexpr std::size_t kCompared = 10'000'000, kFew = 2000;
    const SphereSet set = spheres_on(scene, kFew, kOverlap);
    const auto points = points_on(scene, kCompared, 3);
    const std::size_t different = count_differences(*by_octree(set.spheres, 1), set.spheres, points);
    fmt::print("Of {} queries of {} spheres, {} differ from brute force.\n\n", kCompared, kFew, different);
    if (different > 0) return 1;
  }
  fmt::print(
      "| spheres | octree, ns a query | nanoflann | grid | octree beside nanoflann | build: 1 thread, s | 2 "
      "threads | "
      "speed-up |\n| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  const auto points = points_on(scene, kQueries, 2);
  for (const std::size_t count : {10'000, 100'000, 1'000'000, 10'000'000}) {
    const SphereSet set = spheres_on(scene, count, kOverlap);
    std::vector<std::unique_ptr<LookUp>> ways;
    ways.push_back(by_octree(set.spheres, 2));
    ways.push_back(by_nanoflann(set.spheres, set.radius));
    ways.push_back(by_grid(set.spheres, set.radius));
    const std::vector<Timed> timed = time_queries(ways, points);
    if (timed[0].checksum != timed[1].checksum || timed[0].checksum != timed[2].checksum) {
      fmt::print(stderr, "octree_bench: answers differ at {} spheres\n", count);
      return 1;
    }
    ways.clear();
    const auto [one, two] = time_builds(set.spheres);
    fmt::print("| {} | {:.0f} | {:.0f} | {:.0f} | {:.2f} | {:.3f} | {:.3f} | {:.2f} |\n", count,
               timed[0].nanoseconds, timed[1].nanoseconds, timed[2].nanoseconds,
               timed[1].nanoseconds / timed[0].nanoseconds, one, two, one / two);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: octree_bench SCENE\n");
    return 2;
  }
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "octree_bench: {}\n", error.what());
    return 1;
  }
}

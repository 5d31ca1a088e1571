// Photons by ways that the program has and others, element by element, for bench/photons/*.py:
//   photons_bench cells SCENE.toml MAX_EDGE VARIANT PHOTONS...  > cells.csv
//   photons_bench generation SCENE.toml PHOTONS                 > generation.csv
// VARIANT: sobol, halton, scrambled, random; sobol-even-odd, halton-even-odd; sobol-no-reuse;
// sobol-rejection (of one point luminaire, without re-use).

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bench/photons/variants.hpp"
#include "bench/sequences/generators.hpp"
#include "core/error.hpp"
#include "photons/photon_estimates.hpp"
#include "photons/photon_task.hpp"
#include "scene/polygon.hpp"
#include "scene/scene_input.hpp"
#include "subdivision/subdivide.hpp"

namespace {

using namespace fluxel;
using namespace fluxel::bench;

using Trace = std::function<void(const PhotonScene&, const PhotonRange&, PhotonTally&)>;

/// In parts, by all threads.
template <class Numbers, class Emit>
void trace_all(const PhotonScene& scene, const Emit& emit, const PhotonRange& range, PhotonTally& tally) {
  constexpr std::uint64_t kPart = 4096;
  tbb::parallel_for(std::uint64_t{0}, (range.last - range.first + kPart - 1) / kPart, [&](std::uint64_t k) {
    const std::uint64_t first = range.first + k * kPart;
    Numbers numbers(1);
    trace_task(scene, numbers, emit, {first, std::min(first + kPart, range.last)}, tally);
  });
}

template <class Numbers>
Trace of_numbers() {
  return [](const PhotonScene& scene, const PhotonRange& range, PhotonTally& tally) {
    trace_all<Numbers>(
        scene, [&](Numbers& numbers) { return scene.sources().emit(numbers); }, range, tally);
  };
}

Trace of_sequence(Sequence sequence) {
  return [sequence](const PhotonScene& scene, const PhotonRange& range, PhotonTally& tally) {
    trace_photons(scene, {sequence, 1}, range, tally);
  };
}

struct LoadedScene {
  explicit LoadedScene(const std::string& file, double max_edge) {
    SceneSettings settings;
    settings.specular = Specular::follow;
    const SceneInput input = read_scene_input(file);
    for (const InputOption& option : input.options)
      if (option.name == "sides") settings.sides = option.value == "one" ? Sides::one : Sides::two;
    scene = build_scene(input, settings);
    if (max_edge > 0) {
      SplitCriterion criterion;
      criterion.max_edge = max_edge;
      mesh = subdivide_pieces(scene, 0, scene.pieces.size(), {}, criterion).mesh;
    }
    rays.emplace(scene, 1);
    photons.emplace(*rays, mesh, std::span<const Receiver>());
  }

  Scene scene;
  ElementMesh mesh;
  std::optional<RayScene> rays;
  std::optional<PhotonScene> photons;
};

/// Of each element that anything comes to: its middle, and the irradiance of both sides together.
void write_cells(const LoadedScene& of, const PhotonTally& tally, std::uint64_t photons) {
  std::vector<double> areas;
  for (std::size_t k = 0; k < tally.shape().sides; ++k)
    areas.push_back(static_cast<double>(of.mesh.elements[k % of.mesh.elements.size()].area));
  const auto found = irradiance_estimates(tally, {0, areas, false}, of.photons->sources().power());
  for (std::size_t k = 0; k < of.mesh.elements.size(); ++k) {
    SensorEstimate sum = found[k];
    if (const std::size_t back = k + of.mesh.elements.size(); back < found.size()) {
      sum.mean += found[back].mean;
      sum.half_a += found[back].half_a;
      sum.half_b += found[back].half_b;
    }
    if (sum.mean == Rgb(0)) continue;
    const glm::dvec3 at = centroid(corners(widen(of.mesh.outlines[k]))) + of.scene.origin;
    fmt::print("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", photons, at.x, at.y, at.z, sum.mean.g,
               sum.half_a.g, sum.half_b.g);
  }
}

int run_cells(const std::vector<std::string>& words) {
  const LoadedScene of(words[1], std::stod(words[2]));
  const std::map<std::string, Trace> variants{
      {"sobol", of_sequence(Sequence::sobol)},
      {"halton", of_sequence(Sequence::halton)},
      {"scrambled", of_sequence(Sequence::scrambled)},
      {"random", of_sequence(Sequence::random)},
      {"sobol-even-odd", of_numbers<PhotonNumbers<EvenAndOdd<SobolSequence>>>()},
      {"halton-even-odd", of_numbers<PhotonNumbers<EvenAndOdd<HaltonSequence>>>()},
      {"sobol-no-reuse", of_numbers<NoReuse<PlainPoints<SobolSequence>>>()},
      {"sobol-rejection", [&](const PhotonScene& scene, const PhotonRange& range, PhotonTally& tally) {
         const RejectedEmission emission(of.scene, static_cast<double>(of.rays->surface_epsilon()));
         trace_all<NoReuse<PlainPoints<SobolSequence>>>(scene, emission, range, tally);
       }}};
  const auto found = variants.find(words[3]);
  if (found == variants.end()) throw InputError("no such variant: " + words[3]);
  PhotonTally tally(of.photons->shape(words[3] == "scrambled" ? parts_of(Sequence::scrambled) : 2, false));
  fmt::print("photons,x,y,z,irradiance,half_a,half_b\n");
  std::uint64_t sent = 0;
  for (std::size_t k = 4; k < words.size(); ++k) {
    const std::uint64_t until = std::stoull(words[k]);
    found->second(*of.photons, {sent, until}, tally);
    sent = until;
    write_cells(of, tally, until);
  }
  fmt::print(stderr, "{}: {:.4g} coordinates a photon\n", words[3],
             static_cast<double>(tally.count(PhotonCount::coordinates)) / static_cast<double>(sent));
  return 0;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Any generator of bench/sequences, of more coordinates than its five: those of further bases it makes as if
/// they were these.
template <class Generator>
class FiveDimensions {
 public:
  void start(std::uint64_t index) {
    index_ = index;
    generator_.start(index);
    used_ = 0;
  }
  double next() {
    if (used_ > 0 && used_ % bench::kDimensions == 0) generator_.start(index_);
    ++used_;
    return generator_.next();
  }

 private:
  Generator generator_;
  std::uint64_t index_ = 0;
  std::size_t used_ = 0;
};

/// Seconds to make so many coordinates of each point, the least of three.
template <class Generator>
double seconds_of_points(Generator generator, const std::vector<std::uint32_t>& drawn) {
  double least = 1e300, sum = 0;
  for (int k = 0; k < 3; ++k)
    least = std::min(least, seconds_of([&] {
                       for (std::size_t index = 0; index < drawn.size(); ++index) {
                         generator.start(kFirstPlainPoint + index);
                         for (std::uint32_t c = 0; c < drawn[index]; ++c) sum += generator.next();
                       }
                     }));
  if (sum < 0) std::abort();  // so that it is made
  return least;
}

/// The share of making points in a trace: a trace by one thread, whose own points are taken off again, and by
/// each way as many coordinates as it has taken.
int run_generation(const std::vector<std::string>& words) {
  const LoadedScene of(words[1], 0);
  const std::uint64_t photons = std::stoull(words[2]);
  constexpr std::uint32_t kMost = SobolSequence::kDimensions;
  std::vector<std::uint32_t> drawn;
  double trace = 1e300, coordinates = 0;
  for (int k = 0; k < 3; ++k) {
    PhotonNumbers<PlainPoints<SobolSequence>> numbers(1);
    drawn.clear();
    trace = std::min(trace, seconds_of([&] {
                       for (std::uint64_t index = 0; index < photons; ++index) {
                         const std::uint64_t before = numbers.drawn();
                         numbers.start(index);
                         static_cast<void>(of.photons->follow(of.photons->sources().emit(numbers), numbers,
                                                              [](std::size_t, std::size_t, const Rgb&) {}));
                         drawn.push_back(static_cast<std::uint32_t>(
                             std::min<std::uint64_t>(numbers.drawn() - before, kMost)));
                       }
                     }));
  }
  for (const std::uint32_t count : drawn) coordinates += count;
  const double rest = trace - seconds_of_points(SobolSequence(), drawn);
  fmt::print("{} photons, {:.3g} coordinates each, {:.3g} s without points\npoints,points_s,share\n", photons,
             coordinates / static_cast<double>(photons), rest);
  const auto write = [&](const char* name, double points) {
    fmt::print("{},{:.4g},{:.3g}\n", name, points, points / (rest + points));
  };
  write("halton-plain", seconds_of_points(FiveDimensions<PlainHalton>(), drawn));
  write("halton", seconds_of_points(HaltonSequence(), drawn));
  write("sobol-plain", seconds_of_points(FiveDimensions<PlainSobol>(), drawn));
  write("sobol", seconds_of_points(SobolSequence(), drawn));
  write("random", seconds_of_points(RandomSequence(1), drawn));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() > 4 && words[0] == "cells") return run_cells(words);
    if (words.size() == 3 && words[0] == "generation") return run_generation(words);
    fmt::print(stderr,
               "usage: photons_bench cells SCENE MAX_EDGE VARIANT PHOTONS...\n"
               "       photons_bench generation SCENE PHOTONS\n");
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "photons_bench: {}\n", error.what());
    return 2;
  }
}

#include "method/picture_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "core/ids.hpp"
#include "core/options.hpp"
#include "method/relative_error.hpp"
#include "method/sparse_gather.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

namespace fluxel {

namespace {

/// Of the error that pixels on their own would need: what the first rays are for, of all light and of that
/// from emitters alone, whose noise is less even.
constexpr double kFirst = 4, kFirstOfEmitters = 2.2;

/// The next pass is for this of what would be needed if errors of filtered pixels fell as those of single
/// ones, which is a little more than they do.
constexpr double kAim = 0.9;

/// Of the first rays' seed: others have those of the probes.
constexpr std::uint64_t kPictureSeed = std::uint64_t{1} << 32;

/// By links, what records say of each other is less than the error between them. By comparing pictures of the
/// Cornell box, where it was 1.2 to 1.3 times as much; by rays, of a hall, 1.0.
constexpr double kHiddenBetween = 1.25;

/// Of rays to emitters by links, over those of records: where nothing stands between there are none.
constexpr double kToEmitters = 1.5;

/// Where these are too noisy beside what is between records: of what is left for them, what is aimed at; of
/// their noise, the least that more of them are to bring it down to; and what the seed of these is further.
constexpr double kAimOfEmitters = 0.95, kMostOfEmitters = 0.4;
constexpr std::uint64_t kSecondSeed = 2;

/// Where all light comes by rays: of the error that is allowed, that of what is reflected, and what its
/// records are gathered with over what each pixel would be; fits take more of their noise than they add.
constexpr double kOfReflected = 0.7, kByRays = 0.9;

/// Where records do not come to what is allowed, they are tried once more: for less of it by what the error
/// is too large by and this, but for so much at least.
constexpr double kAimAnew = 0.8, kLeastAnew = 0.6;
constexpr std::uint64_t kTries = 2;

/// Of the pixels: where more than that are gathered for records, all are.
constexpr double kMostGathered = 0.25;

/// What the error is at least, with a certainty of two standard errors, by what is known of the probes.
double certain_error(const NodeTree& tree, std::span<const GatherPoint> points,
                     std::span<const Rgb> irradiance, const PictureGoal& goal) {
  Rgb sum(0), squares(0);
  const auto count = static_cast<double>(goal.probes.size());
  for (std::size_t k = 0; k < goal.probes.size(); ++k) {
    const std::uint32_t pixel = goal.probes[k];
    const Rgb B = tree.material(points[pixel].face).rho * irradiance[pixel];
    const Rgb square = (B - goal.probed.B[k]) * (B - goal.probed.B[k]) - goal.probed.noise;
    sum += square;
    squares += square * square;
  }
  const Rgb mean = sum / count;
  const Rgb standard_error = glm::sqrt(glm::max(Rgb(0), squares / count - mean * mean) / count);
  return root_over_mean(glm::max(Rgb(0), mean - 2.0 * standard_error), goal.probed.mean);
}

/// Light of pixels by few rays and a filter.
struct FilteredLight {
  std::vector<Rgb> irradiance;
  double error = 0;
};

/// What is gathered, and the error that it may have, as PictureGoal::allowed.
struct FilteredGoal {
  LightFrom from = LightFrom::everywhere;
  double allowed = 0;
};

FilteredLight filter_light(const Problem& problem, IrradianceSource& source, int width,
                           std::span<const GatherPoint> points, const PictureGoal& goal,
                           const FilteredGoal& part) {
  const IrradianceFilter filter(width, surfaces_of(source.tree(), points));
  IrradianceHalves sums{std::vector<Rgb>(points.size()), std::vector<Rgb>(points.size())};
  double weight = 0;  // of all rays so far: over the square of the error that they are for
  double wanted = (part.from == LightFrom::emission ? kFirstOfEmitters : kFirst) * goal.ray_error;
  // Where no neighbours help, pixels are as good on their own, and are said to be worse than that. With a
  // limit of time there is none for more.
  const double finest = problem.options.seconds ? goal.ray_error : goal.ray_error / kHiddenByFilter;
  for (std::uint64_t pass = 0;; ++pass) {
    // With those before as good as wanted.
    const double added = 1 / (wanted * wanted) - weight;
    const IrradianceHalves found = source.gather_halves(
        points, {1 / std::sqrt(added), source.mean_radiosity(), kPictureSeed + pass, part.from},
        problem.progress);
    weight += added;
    IrradianceHalves means = sums;
    for (std::size_t half = 0; half < 2; ++half)
      for (std::size_t k = 0; k < points.size(); ++k) {
        sums[half][k] += added * found[half][k];
        means[half][k] = sums[half][k] / weight;
      }
    const IrradianceHalves filtered = filter_pixels(problem, filter, means);
    FilteredLight light;
    for (std::size_t k = 0; k < points.size(); ++k)
      light.irradiance.push_back(0.5 * (filtered[0][k] + filtered[1][k]));
    light.error = error_by_halves(source.tree(), points, filtered, goal.probed.mean);
    // What the probes say is of all light.
    if (part.from == LightFrom::everywhere)
      light.error = std::max(light.error, certain_error(source.tree(), points, light.irradiance, goal));
    if (light.error <= part.allowed || wanted <= finest) return light;
    wanted = std::max(finest, wanted * std::clamp(kAim * part.allowed / light.error, 0.25, kAim));
  }
}

/// Light from emitters by links, with one error of the rays: of what they lie open to exact.
FilteredLight direct_by_links(const Problem& problem, IrradianceSource& source,
                              std::span<const GatherPoint> points, const PictureGoal& goal,
                              const GatherGoal& rays) {
  FilteredLight light{source.gather(points, rays, problem.progress)};
  // What others say at the probes tells their noise.
  std::vector<GatherPoint> probes;
  for (const std::uint32_t pixel : goal.probes) probes.push_back(points[pixel]);
  GatherGoal again = rays;
  ++again.seed;
  SilentProgress silent;
  std::vector<Rgb> other = source.gather(probes, again, silent), first;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const Rgb& rho = source.tree().material(probes[k].face).rho;
    other[k] *= rho;
    first.push_back(rho * light.irradiance[goal.probes[k]]);
  }
  light.error = root_over_mean(mean_square(first, other) / 2.0, goal.probed.mean);
  return light;
}

/// The same, with more rays where the first ones are noisier than `allowed`, but not so much that a finer
/// picture is the better way.
FilteredLight direct_by_links(const Problem& problem, IrradianceSource& source,
                              std::span<const GatherPoint> points, const PictureGoal& goal, double allowed) {
  GatherGoal rays{kToEmitters * goal.ray_error, source.mean_radiosity(), kPictureSeed, LightFrom::emission};
  FilteredLight light = direct_by_links(problem, source, points, goal, rays);
  const double aim = kAimOfEmitters * allowed, first = 1 / (rays.error * rays.error);
  if (!goal.has_time || !(light.error > allowed) || !(aim >= kMostOfEmitters * light.error)) return light;
  // With the first ones as good as is aimed at.
  rays.error *= aim / std::sqrt(light.error * light.error - aim * aim);
  rays.seed += kSecondSeed;
  const FilteredLight more = direct_by_links(problem, source, points, goal, rays);
  // By how many rays they are, as what few probes say of each would have a part in what is found.
  const double second = 1 / (rays.error * rays.error), all = first + second;
  for (std::size_t k = 0; k < points.size(); ++k)
    light.irradiance[k] = (first * light.irradiance[k] + second * more.irradiance[k]) / all;
  light.error = std::hypot(first * light.error, second * more.error) / all;
  return light;
}

/// By records, once.
PictureLight gather_once(const Problem& problem, IrradianceSource& source, int width,
                         std::span<const GatherPoint> points, const PictureGoal& goal, std::uint64_t seed) {
  const bool by_links = !source.by_rays();
  problem.progress.begin("records of the picture");
  const SparseLight reflected = gather_sparsely(
      problem, source, width, points,
      by_links ? SparseGoal{goal.ray_error, goal.allowed, goal.probed.mean, seed}
               : SparseGoal{kByRays * goal.ray_error, kOfReflected * goal.allowed, goal.probed.mean, seed});
  problem.progress.end();
  const double between = (by_links ? kHiddenBetween : 1) * reflected.error;
  // Of the squared error that is allowed, what is left.
  const double left = std::sqrt(std::max(0.0, goal.allowed * goal.allowed - between * between));
  problem.progress.begin(kGatheringPicture);
  FilteredLight light =
      by_links ? direct_by_links(problem, source, points, goal, left)
               : filter_light(problem, source, width, points, goal,
                              {LightFrom::emission, std::max(kOfReflected * goal.allowed, left)});
  problem.progress.end();
  for (std::size_t k = 0; k < points.size(); ++k) light.irradiance[k] += reflected.irradiance[k];
  const double error = std::max(std::hypot(between, light.error),
                                certain_error(source.tree(), points, light.irradiance, goal));
  return {std::move(light.irradiance), error, reflected.records, reflected.single, goal.ray_error};
}

}  // namespace

std::vector<SeenSurface> surfaces_of(const NodeTree& tree, std::span<const GatherPoint> points) {
  std::vector<SeenSurface> seen(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const NodeId face = points[k].face;
    if (face == kNoNode) continue;
    const Patch& patch = tree.scene().patch(tree.scene().pieces[tree[face].piece].patch);
    seen[k] = {points[k].position, tree[face].shape.normal,
               static_cast<std::uint32_t>(index(patch.material))};
  }
  return seen;
}

IrradianceHalves filter_pixels(const Problem& problem, const IrradianceFilter& filter,
                               const IrradianceHalves& halves) {
  const Ranks ranks = ranks_of(problem.world);
  const std::size_t pixels = halves[0].size();
  const IrradianceHalves own = filter.filter(halves, pixels * ranks.rank / ranks.size,
                                             pixels * (ranks.rank + 1) / ranks.size, problem.threads);
  return {ranks.gather(std::span<const Rgb>(own[0])), ranks.gather(std::span<const Rgb>(own[1]))};
}

double error_by_halves(const NodeTree& tree, std::span<const GatherPoint> points,
                       const IrradianceHalves& halves, const Rgb& mean) {
  Rgb squares(0);
  std::size_t count = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k].face == kNoNode) continue;
    const Rgb d = tree.material(points[k].face).rho * 0.5 * (halves[0][k] - halves[1][k]);
    squares += d * d;
    ++count;
  }
  return kHiddenByFilter * root_over_mean(squares / static_cast<double>(count), mean);
}

PictureLight gather_cached(const Problem& problem, IrradianceSource& source, int width,
                           std::span<const GatherPoint> points, const PictureGoal& goal) {
  double finer = 1;
  for (std::uint64_t k = 0; k < kTries; ++k) {
    PictureLight light = gather_once(
        problem, source, width, points,
        {goal.probes, goal.probed, finer * goal.ray_error, finer * goal.allowed, goal.has_time}, k);
    if (light.error <= goal.allowed || !goal.has_time) return light;
    // Pixels are too few for what they show.
    if (static_cast<double>(light.records + light.single) >
        kMostGathered * static_cast<double>(points.size()))
      break;
    finer = std::max(kLeastAnew, kAimAnew * goal.allowed / *light.error);
  }
  return gather_each(problem, source, width, points, goal);
}

PictureLight gather_each(const Problem& problem, IrradianceSource& source, int width,
                         std::span<const GatherPoint> points, const PictureGoal& goal) {
  problem.progress.begin(kGatheringPicture);
  PictureLight light;
  light.ray_error = goal.ray_error;
  if (!source.by_rays()) {
    light.irradiance = source.gather(points, {goal.ray_error, source.mean_radiosity()}, problem.progress);
  } else {
    FilteredLight filtered =
        filter_light(problem, source, width, points, goal, {LightFrom::everywhere, goal.allowed});
    light.irradiance = std::move(filtered.irradiance);
    light.error = filtered.error;
  }
  problem.progress.end();
  return light;
}

}  // namespace fluxel

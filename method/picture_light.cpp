#include "method/picture_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "core/ids.hpp"
#include "method/relative_error.hpp"
#include "method/sparse_gather.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

namespace fluxel {

namespace {

/// Of the error that pixels on their own would need: what the first rays are for.
constexpr double kFirst = 4;

/// What halves that are filtered differ by is less than their error, as each lies between its neighbours. By
/// comparing pictures of stairs and a hall, where it was 1.0 to 1.23 times as much.
constexpr double kHidden = 1.2;

/// The next pass is for this of what would be needed if errors of filtered pixels fell as those of single
/// ones, which is a little more than they do; at most for this of the last one, as a pass has first rays of
/// its own.
constexpr double kAim = 0.9;

/// Of the first rays' seed: others have those of the probes.
constexpr std::uint64_t kPictureSeed = std::uint64_t{1} << 32;

/// What records say of each other is less than the error between them. By comparing pictures of the Cornell
/// box, where it was 1.2 to 1.3 times as much.
constexpr double kHiddenBetween = 1.25;

/// Of rays to emitters by links, over those of records: where nothing stands between there are none.
constexpr double kToEmitters = 1.5;

/// Of the error that is allowed where all light comes by rays: that of what is reflected.
constexpr double kOfReflected = 0.7;

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

/// What is gathered, as PictureGoal has it, beside what is known of the pixels' light.
struct FilteredGoal {
  LightFrom from = LightFrom::everywhere;
  double allowed = 0;
  std::span<const Rgb> known;  ///< none: nothing
};

FilteredLight filter_light(const Problem& problem, Hierarchy& hierarchy, int width,
                           std::span<const GatherPoint> points, const PictureGoal& goal,
                           const FilteredGoal& part) {
  const IrradianceFilter filter(width, surfaces_of(hierarchy.tree(), points));
  IrradianceHalves sums{std::vector<Rgb>(points.size()), std::vector<Rgb>(points.size())};
  double weight = 0;  // of all rays so far: over the square of the error that they are for
  double wanted = kFirst * goal.ray_error;
  // Where no neighbours help, pixels are as good on their own, and are said to be worse than that. With a
  // limit of time there is none for more.
  const double finest = problem.options.seconds ? goal.ray_error : goal.ray_error / kHidden;
  for (std::uint64_t pass = 0;; ++pass) {
    // With those before as good as wanted.
    const double added = 1 / (wanted * wanted) - weight;
    const IrradianceHalves found = hierarchy.gather_halves(
        points, {1 / std::sqrt(added), hierarchy.mean_radiosity(), kPictureSeed + pass, part.from},
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
    for (std::size_t k = 0; k < part.known.size(); ++k) light.irradiance[k] += part.known[k];
    if (mean_of_colours(goal.probed.mean) > 0)
      light.error = std::max(error_by_halves(hierarchy.tree(), points, filtered, goal.probed.mean),
                             certain_error(hierarchy.tree(), points, light.irradiance, goal));
    if (light.error <= part.allowed || wanted <= finest) return light;
    wanted = std::max(finest, wanted * std::clamp(kAim * part.allowed / light.error, 0.25, kAim));
  }
}

/// Of light from emitters at the probes, what rays make of it.
double error_at_probes(Hierarchy& hierarchy, std::span<const GatherPoint> points, std::span<const Rgb> direct,
                       const PictureGoal& goal) {
  std::vector<GatherPoint> probes;
  std::vector<Rgb> first;
  for (const std::uint32_t pixel : goal.probes) {
    const Rgb& rho = hierarchy.tree().material(points[pixel].face).rho;
    probes.push_back(points[pixel]);
    first.push_back(rho * direct[pixel]);
  }
  SilentProgress silent;
  std::vector<Rgb> other = hierarchy.gather(
      probes,
      {kToEmitters * goal.ray_error, hierarchy.mean_radiosity(), kPictureSeed + 1, LightFrom::emission},
      silent);
  for (std::size_t k = 0; k < probes.size(); ++k) other[k] *= hierarchy.tree().material(probes[k].face).rho;
  return root_over_mean(mean_square(first, other) / 2.0, goal.probed.mean);
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
  return kHidden * root_over_mean(squares / static_cast<double>(count), mean);
}

PictureLight gather_filtered(const Problem& problem, Hierarchy& hierarchy, int width,
                             std::span<const GatherPoint> points, const PictureGoal& goal) {
  FilteredLight light =
      filter_light(problem, hierarchy, width, points, goal, {LightFrom::everywhere, goal.allowed, {}});
  return {std::move(light.irradiance), light.error};
}

PictureLight gather_cached(const Problem& problem, Hierarchy& hierarchy, int width,
                           std::span<const GatherPoint> points, const PictureGoal& goal) {
  const bool by_links = hierarchy.cut().empty();
  SparseLight reflected = gather_sparsely(
      problem, hierarchy, width, points,
      {goal.ray_error, by_links ? goal.allowed : kOfReflected * goal.allowed, goal.probed.mean});
  PictureLight light{{}, kHiddenBetween * reflected.error, reflected.records, reflected.single};
  if (!by_links) {
    const double allowed =
        std::max(kOfReflected, std::sqrt(std::max(0.0, 1 - std::pow(light.error / goal.allowed, 2))));
    FilteredLight found = filter_light(problem, hierarchy, width, points, goal,
                                       {LightFrom::emission, allowed * goal.allowed, reflected.irradiance});
    light.irradiance = std::move(found.irradiance);
    light.error = std::hypot(light.error, found.error);
    return light;
  }
  light.irradiance = hierarchy.gather(
      points, {kToEmitters * goal.ray_error, hierarchy.mean_radiosity(), kPictureSeed, LightFrom::emission},
      problem.progress);
  if (mean_of_colours(goal.probed.mean) > 0)
    light.error = std::hypot(light.error, error_at_probes(hierarchy, points, light.irradiance, goal));
  for (std::size_t k = 0; k < points.size(); ++k) light.irradiance[k] += reflected.irradiance[k];
  if (mean_of_colours(goal.probed.mean) > 0)
    light.error = std::max(light.error, certain_error(hierarchy.tree(), points, light.irradiance, goal));
  return light;
}

}  // namespace fluxel

#include "method/picture_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "core/ids.hpp"
#include "method/relative_error.hpp"
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

/// What the error is at least, with a certainty of two standard errors, by what is known of the probes.
double certain_error(const NodeTree& tree, std::span<const GatherPoint> points,
                     const IrradianceHalves& halves, const PictureGoal& goal) {
  Rgb sum(0), squares(0);
  const auto count = static_cast<double>(goal.probes.size());
  for (std::size_t k = 0; k < goal.probes.size(); ++k) {
    const std::uint32_t pixel = goal.probes[k];
    const Rgb B = tree.material(points[pixel].face).rho * 0.5 * (halves[0][pixel] + halves[1][pixel]);
    const Rgb square = (B - goal.probed.B[k]) * (B - goal.probed.B[k]) - goal.probed.noise;
    sum += square;
    squares += square * square;
  }
  const Rgb mean = sum / count;
  const Rgb standard_error = glm::sqrt(glm::max(Rgb(0), squares / count - mean * mean) / count);
  return root_over_mean(glm::max(Rgb(0), mean - 2.0 * standard_error), goal.probed.mean);
}

double error_of(const NodeTree& tree, std::span<const GatherPoint> points, const IrradianceHalves& halves,
                const PictureGoal& goal) {
  if (!(mean_of_colours(goal.probed.mean) > 0)) return 0;
  return std::max(error_by_halves(tree, points, halves, goal.probed.mean),
                  certain_error(tree, points, halves, goal));
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
        points, {1 / std::sqrt(added), hierarchy.mean_radiosity(), kPictureSeed + pass}, problem.progress);
    weight += added;
    IrradianceHalves means = sums;
    for (std::size_t half = 0; half < 2; ++half)
      for (std::size_t k = 0; k < points.size(); ++k) {
        sums[half][k] += added * found[half][k];
        means[half][k] = sums[half][k] / weight;
      }
    IrradianceHalves filtered = filter_pixels(problem, filter, means);
    const double error = error_of(hierarchy.tree(), points, filtered, goal);
    if (error <= goal.allowed || wanted <= finest) {
      for (std::size_t k = 0; k < points.size(); ++k)
        filtered[0][k] = 0.5 * (filtered[0][k] + filtered[1][k]);
      return {std::move(filtered[0]), error};
    }
    wanted = std::max(finest, wanted * std::clamp(kAim * goal.allowed / error, 0.25, kAim));
  }
}

}  // namespace fluxel

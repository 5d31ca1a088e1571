#include "method/round_preview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/options.hpp"
#include "core/signals.hpp"
#include "method/picture_light.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

namespace {

/// Pixels of the picture along each axis for one of a preview.
constexpr int kCoarser = 4;

/// Of the target: what rays of a pixel may be off by before they are filtered.
constexpr double kRayError = 1;

/// Of the first preview's seed: other rays have those of the probes and of the picture.
constexpr std::uint64_t kPreviewSeed = std::uint64_t{1} << 33;

}  // namespace

RoundPreview::RoundPreview(const Problem& problem, Hierarchy& hierarchy, const Raster& raster,
                           std::span<const GatherPoint> points)
    : problem_(problem), hierarchy_(hierarchy) {
  const int step = kCoarser * problem.options.supersample;
  width_ = (raster.width + step - 1) / step;
  height_ = (raster.height + step - 1) / step;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const int from_x = std::min(raster.width - 1, step * x + step / 2);
      const int from_y = std::min(raster.height - 1, step * y + step / 2);
      points_.push_back(points[static_cast<std::size_t>(from_y) * static_cast<std::size_t>(raster.width) +
                               static_cast<std::size_t>(from_x)]);
    }
}

void RoundPreview::show(std::size_t round, double target, std::optional<double> discretisation) {
  std::uint64_t asked = take_snapshot_request() ? 1 : 0;
  problem_.world.all_sum(std::span(&asked, 1));
  if (!problem_.options.preview && asked == 0) return;
  problem_.progress.begin("preview");
  make(round, target, discretisation);
  problem_.progress.end();
}

void RoundPreview::make(std::size_t round, double target, std::optional<double> discretisation) {
  const NodeTree& tree = hierarchy_.tree();
  const IrradianceHalves halves =
      filter_pixels(problem_, IrradianceFilter(width_, surfaces_of(tree, points_)),
                    hierarchy_.gather_halves(
                        points_, {kRayError * target, hierarchy_.mean_radiosity(), kPreviewSeed + round},
                        problem_.progress));
  EarlyPicture picture{width_, height_, {}, {}, {}};
  Rgb reflected(0);
  std::size_t seen = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const NodeId face = points_[k].face;
    picture.irradiance.push_back(0.5 * (halves[0][k] + halves[1][k]));
    picture.exitance.push_back(face == kNoNode ? Rgb(0) : tree.emission(face));
    picture.reflectance.push_back(face == kNoNode ? Rgb(0) : tree.material(face).rho);
    if (face == kNoNode) continue;
    reflected += picture.reflectance.back() * picture.irradiance.back();
    ++seen;
  }
  std::string file;
  on_root(problem_.world, [&] { file = problem_.hooks.round_picture(picture, round); });
  std::string error = "its error is not known yet";
  if (discretisation && mean_of_colours(reflected) > 0)
    error = fmt::format(
        "its error is about {:.2g} %",
        100 * std::hypot(*discretisation,
                         error_by_halves(tree, points_, halves, reflected / static_cast<double>(seen))));
  problem_.log.say(
      fmt::format("preview: round {}, {} x {} pixels, {}: {}", round, width_, height_, error, file));
}

}  // namespace fluxel

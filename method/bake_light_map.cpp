#include "method/bake_light_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/options.hpp"
#include "final_gather/irradiance_filter.hpp"
#include "method/light_map_layout.hpp"
#include "method/light_map_points.hpp"
#include "method/picture_light.hpp"
#include "method/root_gather.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

namespace {

/// Of the rays' seeds, of which probes, pictures and meshes have others.
constexpr std::uint64_t kLightMapSeed = std::uint64_t{1} << 34;

/// Noise that texels may have before it is filtered out, over what is allowed. In a map of the Cornell box
/// filtering left 0.3 of it.
constexpr double kBeforeFilter = 2;

/// Around and within a chart every texel gets the light of the nearest that has some, ring by ring.
class Dilation {
 public:
  explicit Dilation(LightMap& map) : map_(map), width_(map.layout.width) {}

  void fill(std::uint32_t number) {
    const LightMapChart& chart = map_.layout.charts[number];
    low_ = chart.place - kLightMapPadding;
    high_ = chart.place + chart.texels + kLightMapPadding;
    std::vector<glm::ivec2> ring;
    for (glm::ivec2 at = low_; at.y < high_.y; ++at.y)
      for (at.x = low_.x; at.x < high_.x; ++at.x)
        if (map_.chart[texel(at)] == number) ring.push_back(at);
    while (!ring.empty()) {
      std::vector<glm::ivec2> next;
      for (const glm::ivec2& way : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)})
        for (const glm::ivec2& from : ring) spread(from, from + way, number, next);
      ring = std::move(next);
    }
  }

 private:
  [[nodiscard]] std::size_t texel(const glm::ivec2& at) const {
    return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(at.x);
  }

  void spread(const glm::ivec2& from, const glm::ivec2& to, std::uint32_t number,
              std::vector<glm::ivec2>& next) {
    if (to.x < low_.x || to.y < low_.y || to.x >= high_.x || to.y >= high_.y) return;
    if (map_.chart[texel(to)] != LightMap::kNone) return;
    map_.chart[texel(to)] = number;
    map_.H[texel(to)] = map_.H[texel(from)];
    map_.noise_of_H[texel(to)] = map_.noise_of_H[texel(from)];
    next.push_back(to);
  }

  LightMap& map_;
  int width_;
  glm::ivec2 low_{0}, high_{0};
};

/// Noise is taken out of halves within each chart; a point that several show has the light of the first.
IrradianceHalves filtered(const LightMapLayout& layout, const LightMapPoints& points, const NodeTree& tree,
                          const IrradianceHalves& halves, int threads) {
  IrradianceHalves found{std::vector<Rgb>(points.points.size()), std::vector<Rgb>(points.points.size())};
  for (const LightMapChart& chart : layout.charts) {
    const auto columns = static_cast<std::size_t>(chart.texels.x),
               rows = static_cast<std::size_t>(chart.texels.y);
    std::vector<GatherPoint> seen(rows * columns);
    IrradianceHalves here{std::vector<Rgb>(seen.size()), std::vector<Rgb>(seen.size())};
    const auto in_map = [&](std::size_t k) {
      return (static_cast<std::size_t>(chart.place.y) + k / columns) *
                 static_cast<std::size_t>(layout.width) +
             static_cast<std::size_t>(chart.place.x) + k % columns;
    };
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const std::uint32_t point = points.point[in_map(k)];
      if (point == LightMap::kNone) continue;
      seen[k] = {tree.face(chart.piece, chart.front), points.points[point].position};
      for (std::size_t half = 0; half < 2; ++half) here[half][k] = halves[half][point];
    }
    const IrradianceFilter filter(chart.texels.x, surfaces_of(tree, seen));
    const IrradianceHalves smooth = filter.filter(here, 0, seen.size(), threads);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const std::uint32_t point = points.point[in_map(k)];
      if (point == LightMap::kNone || points.texel[point] != in_map(k)) continue;
      for (std::size_t half = 0; half < 2; ++half) found[half][point] = smooth[half][k];
    }
  }
  return found;
}

LightMap light_map_of(LightMapLayout layout, LightMapPoints points, const IrradianceHalves& halves,
                      double noise) {
  const std::vector<Rgb> H = light_of(halves), noise_of_H = noise_of_points(points.points, halves);
  LightMap map;
  map.layout = std::move(layout);
  map.chart = std::move(points.chart);
  map.points = points.points.size();
  map.noise = noise;
  map.H.assign(map.chart.size(), Rgb(0));
  map.noise_of_H.assign(map.chart.size(), Rgb(0));
  for (std::size_t texel = 0; texel < map.chart.size(); ++texel) {
    if (map.chart[texel] == LightMap::kNone) continue;
    map.H[texel] = H[points.point[texel]];
    map.noise_of_H[texel] = kHiddenByFilter * noise_of_H[points.point[texel]];
  }
  Dilation dilation(map);
  for (std::uint32_t number = 0; number < map.layout.charts.size(); ++number) dilation.fill(number);
  return map;
}

}  // namespace

bool bakes_light_map(const Options& options) {
  return options.writes("lightmap") && !options.dry_run && !options.visibility_only;
}

void require_light_map_fits(const Problem& problem) {
  on_root(problem.world, [&] { static_cast<void>(lay_out(problem.scene, problem.options.lightmap_texel)); });
}

void bake_light_map(const Problem& problem, IrradianceSource& source, double target, Solution& solution) {
  LightMapLayout layout;
  LightMapPoints points;
  on_root(problem.world, [&] {
    layout = lay_out(problem.scene, problem.options.lightmap_texel);
    points = points_of(layout, source.tree(), problem.ray_scene);
  });
  const RootGather light = gather_on_root(problem, source, points.points,
                                          kBeforeFilter * allowed_noise(target), kLightMapSeed, "light map");
  if (!problem.world.is_root()) return;
  const IrradianceHalves smooth = filtered(layout, points, source.tree(), light.halves, problem.threads);
  const double noise = error_by_halves(source.tree(), points.points, smooth, light.mean);
  solution.light_map = light_map_of(std::move(layout), std::move(points), smooth, noise);
}

}  // namespace fluxel

#include "method/light_map_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "core/error.hpp"
#include "method/rectangle_packing.hpp"
#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

/// Sides of maps [texels].
constexpr int kUsualSide = 1024, kLargestSide = 4096;

/// Of a step of a lattice: corners of pieces so near to a texel's middle lie on it.
constexpr double kOnTexel = 1e-6;

/// More columns or rows than any map has room for.
constexpr double kTooMany = 2.0 * kLargestSide;

/// By which texels grow until all has room.
constexpr double kGrowth = 1.03;

struct PieceSide {
  std::uint32_t piece = 0;
  bool front = true;
};

std::vector<PieceSide> unknown_sides(const Scene& scene) {
  std::vector<PieceSide> sides;
  for (std::size_t k = 0; k < scene.pieces.size(); ++k) {
    const std::uint32_t mask = scene.patch(scene.pieces[k].patch).sides;
    if ((mask & kFront) != 0) sides.push_back({static_cast<std::uint32_t>(k), true});
    if ((mask & kBack) != 0) sides.push_back({static_cast<std::uint32_t>(k), false});
  }
  return sides;
}

/// A step of at most `texel` that divides a length, where it is not far less.
double step_of(double length, double texel) {
  if (length < 0.5 * texel) return texel;
  return length / std::max(1.0, std::ceil(length / texel * (1 - kOnTexel)));
}

TexelLattice lattice_along(const Outline<glm::dvec3>& outline, const glm::dvec3& normal, double texel) {
  TexelLattice lattice;
  lattice.normal = normal;
  glm::dvec3 longest(0);
  for (std::size_t k = 0; k < outline.corners; ++k) {
    const glm::dvec3 edge = outline.corner[(k + 1) % outline.corners] - outline.corner[k];
    if (glm::length(edge) > (1 + kOnTexel) * glm::length(longest)) longest = edge;
  }
  lattice.u = glm::normalize(longest);
  lattice.v = glm::cross(lattice.u, normal);  // rows go down
  lattice.origin = outline.corner[0];
  glm::dvec2 low(0), high(0);
  for (const glm::dvec3& corner : corners(outline)) {
    const glm::dvec2 at = lattice.along_axes(corner);
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  lattice.origin = lattice.point(low);
  lattice.step = {step_of(high.x - low.x, texel), step_of(high.y - low.y, texel)};
  return lattice;
}

/// The lattices of planes that pieces lie in, made as they come.
class Lattices {
 public:
  Lattices(double texel, double touching) : texel_(texel), touching_(touching) {}

  std::uint32_t find(const Outline<glm::dvec3>& outline, const glm::dvec3& normal) {
    // Numbers that round to different sides are looked for on both.
    const std::array<double, 4> numbers{kNormals * normal.x, kNormals * normal.y, kNormals * normal.z,
                                        glm::dot(normal, outline.corner[0]) / (4 * touching_)};
    for (unsigned sides = 0; sides < 16; ++sides) {
      Key key;
      for (std::size_t k = 0; k < key.size(); ++k)
        key[k] = static_cast<std::int64_t>(std::floor(numbers[k])) + ((sides >> k) & 1U);
      const auto found = by_plane_.find(key);
      if (found == by_plane_.end()) continue;
      for (const std::uint32_t number : found->second)
        if (holds(lattices_[number], outline, normal)) return number;
    }
    Key key;
    for (std::size_t k = 0; k < key.size(); ++k) key[k] = std::llround(numbers[k]);
    const auto number = static_cast<std::uint32_t>(lattices_.size());
    by_plane_[key].push_back(number);
    lattices_.push_back(lattice_along(outline, normal, texel_));
    return number;
  }

  [[nodiscard]] const std::vector<TexelLattice>& all() const { return lattices_; }

 private:
  using Key = std::array<std::int64_t, 4>;
  static constexpr double kNormals = 256;

  [[nodiscard]] bool holds(const TexelLattice& lattice, const Outline<glm::dvec3>& outline,
                           const glm::dvec3& normal) const {
    return glm::dot(lattice.normal, normal) > 0.999 &&
           std::ranges::all_of(corners(outline), [&](const glm::dvec3& corner) {
             return std::abs(glm::dot(corner - lattice.origin, lattice.normal)) <= touching_;
           });
  }

  double texel_, touching_;
  std::vector<TexelLattice> lattices_;
  std::map<Key, std::vector<std::uint32_t>> by_plane_;
};

LightMapLayout charts_of(const Scene& scene, double texel) {
  LightMapLayout layout;
  layout.texel = texel;
  const std::vector<PieceSide> sides = unknown_sides(scene);
  std::vector<std::size_t> largest_first(sides.size());
  std::iota(largest_first.begin(), largest_first.end(), std::size_t{0});
  std::ranges::stable_sort(largest_first, std::greater(), [&](std::size_t k) {
    return area(corners(scene.pieces[sides[k].piece].outline));
  });
  Lattices lattices(texel, contact_tolerance(scene));
  layout.charts.resize(sides.size());
  for (const std::size_t k : largest_first) {
    const Piece& piece = scene.pieces[sides[k].piece];
    const glm::dvec3& normal = scene.patch(piece.patch).normal;
    LightMapChart& chart = layout.charts[k];
    chart.piece = sides[k].piece;
    chart.front = sides[k].front;
    chart.lattice = lattices.find(piece.outline, chart.front ? normal : -normal);
    const TexelLattice& lattice = lattices.all()[chart.lattice];
    glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
    for (const glm::dvec3& corner : corners(piece.outline)) {
      const glm::dvec2 at = lattice.along_axes(corner) / lattice.step;
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    const glm::dvec2 first = glm::floor(low + kOnTexel);
    chart.first = glm::i64vec2(first);
    chart.texels = glm::ivec2(glm::min(glm::ceil(high - kOnTexel) - first + 1.0, kTooMany));
  }
  layout.lattices = lattices.all();
  return layout;
}

double padded_area(const LightMapLayout& layout) {
  double texels = 0;
  for (const LightMapChart& chart : layout.charts)
    texels += static_cast<double>(chart.texels.x + 2 * kLightMapPadding) *
              static_cast<double>(chart.texels.y + 2 * kLightMapPadding);
  return texels;
}

bool fits(LightMapLayout& layout, int width, int height) {
  if (padded_area(layout) > static_cast<double>(width) * static_cast<double>(height)) return false;
  std::vector<PackedRectangle> rectangles;
  rectangles.reserve(layout.charts.size());
  for (const LightMapChart& chart : layout.charts) {
    rectangles.push_back({chart.texels.x + 2 * kLightMapPadding, chart.texels.y + 2 * kLightMapPadding});
    if (rectangles.back().width > width || rectangles.back().height > height) return false;
  }
  if (!pack(rectangles, width, height)) return false;
  for (std::size_t k = 0; k < rectangles.size(); ++k)
    layout.charts[k].place = glm::ivec2(rectangles[k].x, rectangles[k].y) + kLightMapPadding;
  layout.width = width;
  layout.height = height;
  return true;
}

/// Into the least map, twice as wide as high or a square, of a power of two.
bool fits_any(LightMapLayout& layout) {
  for (int side = 16; side <= kLargestSide; side *= 2)
    if (fits(layout, side, side / 2) || fits(layout, side, side)) return true;
  return false;
}

/// A chart has four texels at least.
double least_area(std::size_t charts) {
  constexpr int kLeast = 2 + 2 * kLightMapPadding;
  return static_cast<double>(charts) * kLeast * kLeast;
}

/// What leaves no room between them [m].
double tight_texel(const Scene& scene, double texels) {
  double surface = 0;
  for (const PieceSide& side : unknown_sides(scene))
    surface += area(corners(scene.pieces[side.piece].outline));
  return std::sqrt(surface / texels);
}

double square(double x) { return x * x; }

/// Texels that are larger than the scene make no difference.
std::optional<LightMapLayout> fit_side(const Scene& scene, int side) {
  const double largest = 4 * scene.extent;
  for (double texel = tight_texel(scene, square(side)); texel < largest; texel *= kGrowth) {
    LightMapLayout layout = charts_of(scene, texel);
    if (fits(layout, side, side)) return layout;
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const Scene& scene, std::optional<double> texel) {
  const std::size_t charts = unknown_sides(scene).size();
  if (texel && 2 * least_area(charts) < square(kLargestSide))
    throw InputError(
        fmt::format("--lightmap-texel {:g} would make a light map of more than {} x {} texels: ask for a "
                    "larger one (about {:.2g} m)",
                    *texel, kLargestSide, kLargestSide, 1.3 * tight_texel(scene, square(kLargestSide))));
  throw InputError(fmt::format(
      "a light map of {} x {} texels has no room for the {} sides of faces that this scene has, each with a "
      "chart of its own: leave lightmap out of --write, or bake a mesh by --mesh-max-edge",
      kLargestSide, kLargestSide, charts));
}

}  // namespace

glm::dvec2 TexelLattice::along_axes(const glm::dvec3& point) const {
  return {glm::dot(point - origin, u), glm::dot(point - origin, v)};
}

glm::dvec2 LightMapLayout::place(const LightMapChart& chart, const glm::dvec3& point) const {
  const TexelLattice& lattice = lattices[chart.lattice];
  return lattice.along_axes(point) / lattice.step - glm::dvec2(chart.first) + glm::dvec2(chart.place) + 0.5;
}

LightMapLayout lay_out(const Scene& scene, std::optional<double> texel) {
  if (texel) {
    if (tight_texel(scene, square(kLargestSide)) > *texel) refuse(scene, texel);
    LightMapLayout layout = charts_of(scene, *texel);
    if (!fits_any(layout)) refuse(scene, texel);
    return layout;
  }
  for (int side = kUsualSide; side <= kLargestSide; side *= 2) {
    if (1.5 * least_area(unknown_sides(scene).size()) > square(side)) continue;
    if (std::optional<LightMapLayout> layout = fit_side(scene, side)) return std::move(*layout);
  }
  refuse(scene, texel);
}

}  // namespace fluxel

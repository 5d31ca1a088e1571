#include "method/smooth_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "core/element.hpp"
#include "core/options.hpp"
#include "subdivision/element_finder.hpp"
#include "subdivision/piece_finder.hpp"

namespace fluxel {

namespace {

/// Bits of the number of rays in a pixel: of one that a lamp fills in part there are more, as what that is
/// off by counts as much more as the lamp is brighter. They are rays alone, as nothing is gathered of
/// emission.
constexpr int kBits = 4, kBitsOfLamps = 8;

/// Points of a pixel of which every interval of 1/n of either axis has one, of n = 2^bits: outlines along the
/// axes have n shades (Hammersley's points: Niederreiter 1992, section 3.1).
glm::dvec2 place_in_pixel(std::uint32_t number, int bits) {
  std::uint32_t reversed = 0;
  for (int bit = 0; bit < bits; ++bit) reversed |= (number >> bit & 1u) << (bits - 1 - bit);
  return (glm::dvec2(number, reversed) + 0.5) / static_cast<double>(1u << bits);
}

/// Of one surface: the least cosine of normals, and how far one place lies off the other's plane, over the
/// distance of both.
constexpr double kSameNormal = 0.99, kOffPlane = 0.2;

/// Around a pixel, to each side: where irradiance is taken from.
constexpr int kReach = 1;

constexpr std::size_t kPixelsAtOnce = 1024;

class EdgeSmoother {
 public:
  EdgeSmoother(const Problem& problem, const Raster& raster, std::span<const Rgb> irradiance)
      : problem_(problem), raster_(raster), irradiance_(irradiance) {
    const PixelRays rays(*problem.options.camera);
    for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel) {
      SeenPlace& centre = centres_.emplace_back();
      centre.patch = raster.patch[pixel];
      if (centre.patch == kNoPatch) continue;
      centre.front = raster.front[pixel] != 0;
      centre.depth = raster.depth[pixel];
      centre.point = pixel_point(problem.scene, *problem.options.camera, rays, raster, pixel);
    }
  }

  std::vector<EdgePixel> run(const LightElsewhere& elsewhere) && {
    const std::vector<std::uint32_t> edges = find_edges();
    // What is seen of a block is not kept: in a picture of leaves all pixels are edges.
    for (std::size_t first = 0; first < edges.size(); first += kPixelsAtOnce)
      look_at(std::span(edges).subspan(first, std::min(kPixelsAtOnce, edges.size() - first)));
    const std::vector<Rgb> found = elsewhere(others_, shares_);
    for (const Waiting& sample : waiting_)
      add_irradiance(sample.reflected * found[sample.other], sample.weight * found[sample.other],
                     smoothed_[sample.edge]);
    return std::move(smoothed_);
  }

 private:
  /// A sample whose light is not known yet.
  struct Waiting {
    std::size_t edge, other;  // numbers
    double weight;
    Rgb reflected;  // reflectance, weighted
  };

  void look_at(std::span<const std::uint32_t> edges) {
    std::vector<std::vector<SeenPlace>> seen = look(edges, kBits);
    std::vector<std::uint32_t> of_lamps;
    for (std::size_t k = 0; k < edges.size(); ++k)
      if (shows_a_lamps_edge(seen[k])) of_lamps.push_back(edges[k]);
    std::vector<std::vector<SeenPlace>> finer = look(of_lamps, kBitsOfLamps);
    for (std::size_t k = 0, lamp = 0; k < edges.size(); ++k) {
      if (lamp < of_lamps.size() && of_lamps[lamp] == edges[k]) seen[k] = std::move(finer[lamp++]);
      take(edges[k], seen[k]);
    }
  }

  /// All samples of a pixel.
  void take(std::uint32_t pixel, std::span<const SeenPlace> samples) {
    EdgePixel& mean = smoothed_.emplace_back();
    mean.pixel = pixel;
    const std::size_t before = others_.size();
    const double weight = 1.0 / static_cast<double>(samples.size());
    for (const SeenPlace& sample : samples) {
      if (!is_lit(sample)) continue;
      const Rgb reflected = weight * problem_.scene.material(problem_.scene.patch(sample.patch)).rho;
      mean.exitance += weight * emission_of(sample);
      mean.reflectance += reflected;
      if (const std::optional<std::size_t> beside = nearest_beside(pixel, sample))
        add_irradiance(reflected * irradiance_[*beside], weight * irradiance_[*beside], mean);
      else
        wait({smoothed_.size() - 1, other_of(sample, before), weight, reflected});
    }
  }

  void wait(const Waiting& sample) {
    waiting_.push_back(sample);
    shares_[sample.other] += sample.weight;
  }

  static void add_irradiance(const Rgb& reflected, const Rgb& irradiance, EdgePixel& to) {
    to.exitance += reflected;
    to.irradiance += irradiance;
  }

  [[nodiscard]] int column_of(std::size_t pixel) const {
    return static_cast<int>(pixel % static_cast<std::size_t>(raster_.width));
  }
  [[nodiscard]] int row_of(std::size_t pixel) const {
    return static_cast<int>(pixel / static_cast<std::size_t>(raster_.width));
  }

  /// Calls `visit` with the numbers of a pixel and of those around it, until it returns true.
  template <class Visit>
  [[nodiscard]] bool any_around(std::size_t pixel, const Visit& visit) const {
    const int column = column_of(pixel), row = row_of(pixel);
    for (int y = std::max(0, row - kReach); y <= std::min(raster_.height - 1, row + kReach); ++y)
      for (int x = std::max(0, column - kReach); x <= std::min(raster_.width - 1, column + kReach); ++x)
        if (visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.width) +
                  static_cast<std::size_t>(x)))
          return true;
    return false;
  }

  [[nodiscard]] glm::dvec3 normal_of(const SeenPlace& place) const {
    const glm::dvec3& normal = problem_.scene.patch(place.patch).normal;
    return place.front ? normal : -normal;
  }

  [[nodiscard]] bool is_same_surface(const SeenPlace& a, const SeenPlace& b) const {
    if (a.patch == b.patch) return a.front == b.front;
    if (a.patch == kNoPatch || b.patch == kNoPatch) return false;
    const glm::dvec3 normal = normal_of(a), way = b.point - a.point;
    return glm::dot(normal, normal_of(b)) > kSameNormal &&
           std::abs(glm::dot(normal, way)) <= kOffPlane * glm::length(way);
  }

  [[nodiscard]] MaterialId material_of(const SeenPlace& place) const {
    return problem_.scene.patch(place.patch).material;
  }

  [[nodiscard]] std::vector<std::uint32_t> find_edges() const {
    std::vector<std::uint32_t> edges;
    for (std::size_t pixel = 0; pixel < centres_.size(); ++pixel) {
      const SeenPlace& centre = centres_[pixel];
      const bool is_edge = any_around(pixel, [&](std::size_t other) {
        const SeenPlace& beside = centres_[other];
        return !is_same_surface(centre, beside) || is_lit(centre) != is_lit(beside) ||
               (centre.patch != kNoPatch && material_of(centre) != material_of(beside));
      });
      if (is_edge) edges.push_back(static_cast<std::uint32_t>(pixel));
    }
    return edges;
  }

  /// What 2^bits rays through each of the pixels see.
  [[nodiscard]] std::vector<std::vector<SeenPlace>> look(std::span<const std::uint32_t> pixels,
                                                         int bits) const {
    const std::uint32_t samples = 1u << bits;
    std::vector<glm::dvec2> places;
    for (const std::uint32_t pixel : pixels)
      for (std::uint32_t k = 0; k < samples; ++k)
        places.push_back(glm::dvec2(column_of(pixel), row_of(pixel)) + place_in_pixel(k, bits));
    const std::vector<SeenPlace> seen =
        see(problem_.ray_scene, problem_.scene, *problem_.options.camera, places, problem_.threads);
    std::vector<std::vector<SeenPlace>> of_pixels;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const auto from = seen.begin() + static_cast<std::ptrdiff_t>(k * samples);
      of_pixels.emplace_back(from, from + samples);
    }
    return of_pixels;
  }

  [[nodiscard]] Rgb emission_of(const SeenPlace& place) const {
    if (place.patch == kNoPatch) return Rgb(0);
    const Material& material = problem_.scene.material(problem_.scene.patch(place.patch));
    return place.front ? material.E : material.back_exitance();
  }
  /// Surfaces of other temperatures are no lamps.
  [[nodiscard]] bool shows_a_lamps_edge(std::span<const SeenPlace> samples) const {
    return !problem_.options.thermal && std::ranges::any_of(samples, [&](const SeenPlace& one) {
      return emission_of(one) != emission_of(samples[0]);
    });
  }

  [[nodiscard]] bool is_lit(const SeenPlace& sample) const {
    if (sample.patch == kNoPatch) return false;
    return (problem_.scene.patch(sample.patch).sides & (sample.front ? kFront : kBack)) != 0;
  }

  /// Of the pixel and those around it the nearest centre that lies on the sample's surface.
  [[nodiscard]] std::optional<std::size_t> nearest_beside(std::size_t pixel, const SeenPlace& sample) const {
    std::optional<std::size_t> nearest;
    double least = std::numeric_limits<double>::infinity();
    static_cast<void>(any_around(pixel, [&](std::size_t beside) {
      const SeenPlace& centre = centres_[beside];
      const double distance = glm::distance(centre.point, sample.point);
      if (distance < least && is_lit(centre) && is_same_surface(centre, sample)) {
        least = distance;
        nearest = beside;
      }
      return false;
    }));
    return nearest;
  }

  /// The number of a sample's place elsewhere, which all of its pixel on one surface share: theirs begin at
  /// `before`.
  [[nodiscard]] std::size_t other_of(const SeenPlace& sample, std::size_t before) {
    for (std::size_t k = before; k < others_.size(); ++k)
      if (is_same_surface(others_[k], sample)) return k;
    others_.push_back(sample);
    shares_.push_back(0);
    return others_.size() - 1;
  }

  const Problem& problem_;
  const Raster& raster_;
  std::span<const Rgb> irradiance_;
  std::vector<SeenPlace> centres_;  // of the pixels
  std::vector<SeenPlace> others_;   // places whose light is asked for
  std::vector<double> shares_;      // of each: the part of a pixel that it stands for
  std::vector<Waiting> waiting_;
  std::vector<EdgePixel> smoothed_;
};

}  // namespace

std::vector<EdgePixel> smooth_edges(const Problem& problem, const Raster& raster,
                                    std::span<const Rgb> irradiance, const LightElsewhere& elsewhere) {
  return EdgeSmoother(problem, raster, irradiance).run(elsewhere);
}

void smooth_gathered_edges(const Problem& problem, IrradianceSource& source, Solution& solution) {
  if (!problem.options.antialias) return;
  const PieceFinder finder(problem.scene);
  const auto gather = [&](std::span<const SeenPlace> places, std::span<const double> shares) {
    std::vector<GatherPoint> points;
    // With the root of the shares, a pixel's squared errors are in the mean those of one point.
    for (std::size_t k = 0; k < places.size(); ++k)
      points.push_back({source.tree().face(finder.find(places[k].patch, places[k].point), places[k].front),
                        places[k].point, std::sqrt(shares[k])});
    SilentProgress silent;
    return source.gather(points, {solution.picture->ray_error, source.mean_radiosity()}, silent);
  };
  solution.edges = smooth_edges(problem, solution.subdivided.raster, solution.pixel_irradiance, gather);
}

void smooth_element_edges(const Problem& problem, Solution& solution) {
  if (!problem.options.antialias) return;
  const ElementView& mesh = solution.subdivided.mesh;
  const std::vector<Rgb> H =
      irradiance_by_materials(mesh.elements, problem.scene.materials, *solution.radiosity);
  const auto irradiance_of = [&](std::size_t element, bool front) {
    const std::size_t unknown = front ? element : mesh.elements.size() + element;
    return unknown < H.size() ? H[unknown] : Rgb(0);
  };
  const Raster& raster = solution.subdivided.raster;
  std::vector<Rgb> irradiance(raster.pixels(), Rgb(0));
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel)
    if (raster.element[pixel] != kNoElement)
      irradiance[pixel] = irradiance_of(index(raster.element[pixel]), raster.front[pixel] != 0);
  const ElementFinder finder(mesh);
  solution.edges = smooth_edges(problem, raster, irradiance, [&](std::span<const SeenPlace> places, auto) {
    std::vector<Rgb> found;
    for (const SeenPlace& place : places) {
      const std::size_t element = finder.find(place.patch, place.point);
      found.push_back(element == ElementFinder::kNone ? Rgb(0) : irradiance_of(element, place.front));
    }
    return found;
  });
}

}  // namespace fluxel

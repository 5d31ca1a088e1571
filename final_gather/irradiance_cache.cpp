#include "final_gather/irradiance_cache.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <utility>

#include "formfactor/free_segments.hpp"

namespace fluxel {

namespace {

/// Of a fit: what keeps slopes that few records tell of from growing, over what they count.
constexpr double kRidge = 0.02;

/// One, two positions, two components of the normal.
constexpr std::size_t kTerms = 5;
using Terms = std::array<double, kTerms>;

template <class Work>
void for_each(std::size_t count, int threads, const Work& work) {
  constexpr std::size_t kGrain = 64;
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) work(k);
    });
  });
}

/// Two unit vectors perpendicular to a unit normal and to each other (Duff et al. 2017).
std::array<glm::dvec3, 2> tangents(const glm::dvec3& n) {
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {glm::dvec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x),
          glm::dvec3(b, sign + n.y * n.y * a, -n.y)};
}

/// Solves A x = (1, 0, ...) for a symmetric, positive A, of which the lower triangle is given (Cholesky).
Terms solve_first(std::array<Terms, kTerms>& A) {
  for (std::size_t j = 0; j < kTerms; ++j) {
    for (std::size_t k = 0; k < j; ++k) A[j][j] -= A[j][k] * A[j][k];
    A[j][j] = std::sqrt(A[j][j]);
    for (std::size_t i = j + 1; i < kTerms; ++i) {
      for (std::size_t k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] /= A[j][j];
    }
  }
  Terms x{1};
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= A[i][k] * x[k];
    x[i] /= A[i][i];
  }
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t k = i + 1; k < kTerms; ++k) x[i] -= A[k][i] * x[k];
    x[i] /= A[i][i];
  }
  return x;
}

/// A record that reaches a place.
struct Near {
  std::uint32_t record;
  double weight;
  double squared;  ///< distance [m2]
  Terms terms;
};

/// Those of other pieces of which something stands before the place are taken out. Ends are lifted over what
/// a curved surface bends between them.
void keep_free(const RayScene& ray_scene, const SidePoint& point, std::span<const IrradianceRecord> records,
               std::vector<Near>& near) {
  std::array<SurfaceSegment, RayPacket::kSize> segments;
  std::array<std::size_t, RayPacket::kSize> of;
  std::size_t count = 0;
  const auto trace = [&] {
    const std::uint32_t free = free_segments(ray_scene, std::span(segments).first(count));
    for (std::size_t k = 0; k < count; ++k)
      if ((free >> k & 1u) == 0) near[of[k]].weight = 0;
    count = 0;
  };
  for (std::size_t k = 0; k < near.size(); ++k) {
    const SidePoint& at = records[near[k].record].at;
    if (at.piece == point.piece) continue;
    const double lift = 0.5 * std::sqrt(near[k].squared) * glm::distance(at.normal, point.normal);
    segments[count] = {at.position + lift * at.normal, at.normal, point.position + lift * point.normal,
                       point.normal};
    of[count++] = k;
    if (count == segments.size()) trace();
  }
  trace();
  std::erase_if(near, [](const Near& one) { return one.weight == 0; });
}

}  // namespace

IrradianceCache::IrradianceCache(const RayScene& ray_scene, std::vector<IrradianceRecord> records,
                                 int threads)
    : ray_scene_(ray_scene), records_(std::move(records)), bend_(records_.size()) {
  find_radii(threads);
  std::vector<Sphere> spheres;
  spheres.reserve(records_.size());
  for (std::size_t k = 0; k < records_.size(); ++k) {
    const glm::vec3 centre(records_[k].at.position);
    // Larger by what rounding moves the centre, and itself.
    const auto moved = static_cast<float>(glm::distance(glm::dvec3(centre), records_[k].at.position));
    spheres.push_back({centre.x, centre.y, centre.z, (radii_[k] + moved) * 1.0001F});
  }
  places_.emplace(spheres, threads);
  look_at_each(threads);
}

/// As far as so many others of the surface.
void IrradianceCache::find_radii(int threads) {
  namespace bg = boost::geometry;
  using Point = bg::model::point<double, 3, bg::cs::cartesian>;
  using Entry = std::pair<Point, std::uint32_t>;
  std::vector<Entry> entries;
  for (std::uint32_t k = 0; k < records_.size(); ++k) {
    const glm::dvec3& x = records_[k].at.position;
    entries.emplace_back(Point(x.x, x.y, x.z), k);
  }
  const bg::index::rtree<Entry, bg::index::linear<16>> tree(entries.begin(), entries.end());
  radii_.assign(records_.size(), 0);
  for_each(records_.size(), threads, [&](std::size_t k) {
    const SidePoint& here = records_[k].at;
    constexpr auto kLooked = static_cast<unsigned>(4 * kReaching);
    std::array<double, kLooked> distances;
    std::size_t found = 0;
    double farthest = 0;
    for (auto at = tree.qbegin(bg::index::nearest(entries[k].first, kLooked)); at != tree.qend(); ++at) {
      const SidePoint& there = records_[at->second].at;
      const double distance = glm::distance(here.position, there.position);
      farthest = std::max(farthest, distance);
      if (of_one_surface(here, there)) distances[found++] = distance;
    }
    std::sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(found));
    // The record is the first of them.
    const double radius = found > kReaching ? distances[kReaching] : farthest;
    radii_[k] = static_cast<float>(radius);
  });
}

Interpolated IrradianceCache::interpolate(const SidePoint& point, std::uint32_t left_out) const {
  thread_local std::vector<Near> near;
  near.clear();
  double all = 0, spread = 0;
  places_->for_each_at(point.position, [&](std::uint32_t k) {
    const SidePoint& at = records_[k].at;
    const glm::dvec3 d = at.position - point.position;
    const double squared = glm::dot(d, d), reach = static_cast<double>(radii_[k]);
    if (k == left_out || squared >= reach * reach) return;
    const double agree = agreement(point, at), off = off_plane(point, at) / (kSurfaceOffPlane * reach);
    if (agree <= 0 || off >= 1) return;
    const double inside = 1 - squared / (reach * reach);
    near.push_back({k, inside * inside * agree * (1 - off * off), squared, {}});
  });
  keep_free(ray_scene_, point, records_, near);
  if (near.empty()) return {};
  for (const Near& one : near) {
    all += one.weight;
    spread += one.weight * one.squared;
  }
  const double scale = spread > 0 ? std::sqrt(all / spread) : 0;
  const double turn = 1 / std::sqrt(1 - kLeastSurfaceCosine * kLeastSurfaceCosine);
  const auto [u, v] = tangents(point.normal);
  std::array<Terms, kTerms> A{};
  for (Near& one : near) {
    const SidePoint& at = records_[one.record].at;
    const glm::dvec3 d = scale * (at.position - point.position), n = turn * (at.normal - point.normal);
    one.terms = {1, glm::dot(d, u), glm::dot(d, v), glm::dot(n, u), glm::dot(n, v)};
    for (std::size_t i = 0; i < kTerms; ++i)
      for (std::size_t j = 0; j <= i; ++j) A[i][j] += one.weight * one.terms[i] * one.terms[j];
  }
  for (std::size_t i = 1; i < kTerms; ++i) A[i][i] += kRidge * all;
  const Terms first = solve_first(A);
  Interpolated found;
  found.records = static_cast<int>(near.size());
  double bends = 0, sizes = 0;
  for (const Near& one : near) {
    double weight = 0;
    for (std::size_t i = 0; i < kTerms; ++i) weight += first[i] * one.terms[i];
    weight *= one.weight;
    found.irradiance += weight * records_[one.record].irradiance;
    found.noise += weight * weight * records_[one.record].variance;
    found.record_noise += one.weight / all * records_[one.record].variance;
    const double size = std::abs(weight);
    found.stretch += size * one.squared;
    found.reach += one.weight / all * static_cast<double>(radii_[one.record]);
    bends += size * bend_[one.record];
    sizes += size;
  }
  if (sizes > 0) found.bend = std::sqrt(std::max(0.0, bends / sizes));
  return found;
}

void IrradianceCache::look_at_each(int threads) {
  std::vector<double> bend(records_.size());
  for_each(records_.size(), threads, [&](std::size_t k) {
    const Interpolated of_others = interpolate(records_[k].at, static_cast<std::uint32_t>(k));
    const double here = mean_of_colours(records_[k].irradiance);
    if (of_others.records == 0) {
      const double reach = std::max(static_cast<double>(radii_[k]), 1e-30);
      bend[k] = here * here / (reach * reach * reach * reach);
      return;
    }
    const double off = mean_of_colours(of_others.irradiance) - here;
    // What noise has made too large there it has made too small elsewhere.
    const double bias = off * off - records_[k].variance - of_others.noise;
    if (of_others.stretch > 0) bend[k] = bias / (of_others.stretch * of_others.stretch);
  });
  bend_ = std::move(bend);
}

}  // namespace fluxel

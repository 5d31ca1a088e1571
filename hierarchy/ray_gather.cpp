#include "hierarchy/ray_gather.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "core/sampling.hpp"
#include "hierarchy/point_rays.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kPointsOfABatch = 4096;

/// Irradiance by each half of a point's rays [W/m2].
using PointHalves = std::array<Rgb, 2>;

/// Of points; none: there is nothing to gather.
using Gathers = std::vector<std::optional<PointGather>>;

/// Traces what points have asked for, first hits of rays of the hemisphere by a device: as many points at a
/// time as fill it.
void trace_by(VerifiedHits& device, Gathers& points) {
  std::vector<Ray> rays;
  std::vector<PatchHit> hits;
  std::vector<std::size_t> begin;  // of each point's rays
  for (std::size_t first = 0; first < points.size();) {
    begin.assign(1, 0);
    std::size_t last = first;
    while (last < points.size() && begin.back() < device.rays_at_once()) {
      begin.push_back(begin.back() + (points[last] ? points[last]->asked() : 0));
      ++last;
    }
    rays.resize(begin.back());
    hits.resize(begin.back());
    const auto for_each = [&](const auto& work) {
      tbb::parallel_for(first, last, [&](std::size_t k) {
        const std::size_t from = begin[k - first], count = begin[k - first + 1] - from;
        if (points[k]) work(*points[k], from, count);
      });
    };
    for_each([&](PointGather& point, std::size_t from, std::size_t count) {
      point.aim(std::span(rays).subspan(from, count));
    });
    device.find(rays, hits);
    for_each([&](PointGather& point, std::size_t from, std::size_t count) {
      point.take(std::span(rays).subspan(from, count), std::span(hits).subspan(from, count));
    });
    first = last;
  }
}

}  // namespace

std::vector<Rgb> mean_of_halves(const std::array<std::vector<Rgb>, 2>& halves) {
  std::vector<Rgb> mean(halves[0].size());
  for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = 0.5 * (halves[0][k] + halves[1][k]);
  return mean;
}

std::array<std::vector<Rgb>, 2> RayGather::gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                                  const GatherCrew& crew, Progress& progress) {
  const MetLight light{emitted_, solution_, scale_, goal.light};
  const Ranks& ranks = crew.ranks;
  std::vector<PointHalves> own;
  for (std::size_t k = ranks.rank; k < points.size(); k += ranks.size) own.emplace_back();
  const auto begin_point = [&](std::size_t k, std::optional<PointGather>& gather) {
    const std::size_t number = k * ranks.size + ranks.rank;
    const GatherPoint& point = points[number];
    if (point.face == kNoNode) return;
    const double rho = mean_of_colours(emitted_.tree().material(point.face).rho);
    gather.emplace(light, emitted_.receiving(point.face, point.position),
                   rays_a_spread(goal, rho, point.weight), random_bits(random_bits(goal.seed) + number));
    gather->ask_pilots();
  };
  std::atomic<std::uint64_t> rays = 0;
  const auto end_point = [&](std::size_t k, const PointGather& gather) {
    own[k] = gather.irradiance();
    rays += gather.rays();
  };
  const auto by_processor = [&](std::size_t from, std::size_t to) {
    tbb::parallel_for(from, to, [&](std::size_t k) {
      std::optional<PointGather> gather;
      if (!crew.is_stopped()) begin_point(k, gather);
      if (!gather) return;
      gather->trace();
      gather->ask_rest();
      gather->trace();
      end_point(k, *gather);
    });
  };
  const auto by_device = [&](std::size_t from, std::size_t to) {
    Gathers gathers(to - from);
    tbb::parallel_for(from, to, [&](std::size_t k) { begin_point(k, gathers[k - from]); });
    trace_by(*device_, gathers);
    for (std::optional<PointGather>& gather : gathers)
      if (gather) gather->ask_rest();
    if (!crew.is_stopped()) trace_by(*device_, gathers);
    for (std::size_t k = from; k < to; ++k)
      if (const auto& gather = gathers[k - from]) end_point(k, *gather);
  };
  tbb::task_arena arena(crew.threads);
  for (std::size_t first = 0; first < points.size(); first += kPointsOfABatch * ranks.size) {
    const std::size_t from = first / ranks.size, to = std::min(own.size(), from + kPointsOfABatch);
    arena.execute([&] {
      if (from >= to) return;
      if (device_ != nullptr)
        by_device(from, to);
      else
        by_processor(from, to);
    });
    crew.between();
    progress.update(static_cast<double>(std::min(points.size(), to * ranks.size)),
                    static_cast<double>(points.size()));
  }
  rays_ += rays;
  const std::vector<PointHalves> gathered = ranks.gather(std::span<const PointHalves>(own));
  std::array halves{std::vector<Rgb>(points.size()), std::vector<Rgb>(points.size())};
  std::size_t next = 0;
  for (std::size_t rank = 0; rank < ranks.size; ++rank)
    for (std::size_t k = rank; k < points.size(); k += ranks.size, ++next)
      for (std::size_t half = 0; half < halves.size(); ++half) halves[half][k] = gathered[next][half];
  return halves;
}

}  // namespace fluxel

#include "method/root_gather.hpp"

#include <algorithm>
#include <cstring>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "core/signals.hpp"
#include "hierarchy/ray_gather.hpp"

#include "method/handle_signals.hpp"
#include "method/probed_rays.hpp"
#include "method/probes.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

namespace {

/// Noise of the gather, root mean square over the mean: of the target error this part, and no more than the
/// other, beyond which smooth walls look blotched.
constexpr double kNoiseShare = 0.4, kMostNoise = 0.02;

/// So many points are on all ranks at a time.
constexpr std::size_t kPointsSentAtOnce = 1 << 16;

/// That many points before and behind one are taken to have the same noise.
constexpr std::size_t kAlike = 8;

void broadcast_points(const Communicator& world, std::vector<GatherPoint>& points) {
  const auto bytes = std::as_bytes(std::span(points));
  Bytes message(bytes.begin(), bytes.end());
  world.broadcast(message);
  points.resize(message.size() / sizeof(GatherPoint));
  if (!points.empty()) std::memcpy(points.data(), message.data(), message.size());
}

/// Collective: throws StopRequest on all ranks where a signal has asked any of them to stop or to end.
void stop_where_asked(const Problem& problem) {
  std::array<std::uint64_t, 1> asked{end_requested() ? 1U : 0U};
  problem.world.all_sum(asked);
  if (asked[0] > 0) throw StopRequest("ended by a signal");
  handle_signals(problem.world, problem.options, problem.log);
}

/// Collective: of the root's points, on the root; two halves.
std::array<std::vector<Rgb>, 2> gather_halves(const Problem& problem, IrradianceSource& source,
                                              std::span<const GatherPoint> points, double ray_error,
                                              std::uint64_t seed, const std::string& what) {
  std::array<std::vector<Rgb>, 2> H;
  problem.progress.begin("gathering the " + what);
  SilentProgress silent;
  for (std::size_t first = 0;; first += kPointsSentAtOnce) {
    std::vector<GatherPoint> some;
    if (problem.world.is_root()) {
      const auto rest = points.subspan(std::min(first, points.size()));
      some.assign(rest.begin(),
                  rest.begin() + static_cast<std::ptrdiff_t>(std::min(kPointsSentAtOnce, rest.size())));
    }
    stop_where_asked(problem);
    broadcast_points(problem.world, some);
    if (some.empty()) break;
    const auto halves = source.gather_halves(
        some, {ray_error, source.mean_radiosity(), seed + first / kPointsSentAtOnce}, silent);
    if (!problem.world.is_root()) continue;
    for (std::size_t half = 0; half < 2; ++half)
      H[half].insert(H[half].end(), halves[half].begin(), halves[half].end());
    problem.progress.update(static_cast<double>(H[0].size()), static_cast<double>(points.size()));
  }
  problem.progress.end();
  return H;
}

}  // namespace

std::vector<Rgb> light_of(const std::array<std::vector<Rgb>, 2>& halves) {
  std::vector<Rgb> light = mean_of_halves(halves);
  for (Rgb& H : light) H = glm::max(H, Rgb(0));
  return light;
}

double allowed_noise(double target) {
  return target > 0 ? std::min(kNoiseShare * target, kMostNoise) : kMostNoise;
}

RootGather gather_on_root(const Problem& problem, IrradianceSource& source,
                          std::span<const GatherPoint> points, double allowed, std::uint64_t seed,
                          const std::string& what) {
  std::vector<GatherPoint> probes;
  on_root(problem.world, [&] {
    for (const std::uint32_t number : choose_probes(source.tree(), points)) probes.push_back(points[number]);
  });
  broadcast_points(problem.world, probes);
  const ProbedRays rays = probe_for(source, probes, allowed);
  return {gather_halves(problem, source, points, rays.ray_error, seed, what), rays.noise, rays.light.mean};
}

std::vector<Rgb> noise_of_points(std::span<const GatherPoint> points,
                                 const std::array<std::vector<Rgb>, 2>& halves) {
  std::vector<Rgb> noise(points.size(), Rgb(0));
  for (std::size_t k = 0; k < points.size(); ++k) {
    Rgb squares(0);
    double alike = 0;
    for (std::size_t other = k - std::min(k, kAlike); other < std::min(points.size(), k + kAlike + 1);
         ++other)
      if (points[other].face == points[k].face) {
        const Rgb error = 0.5 * (halves[1][other] - halves[0][other]);
        squares += error * error;
        ++alike;
      }
    noise[k] = glm::sqrt(squares / alike);
  }
  return noise;
}

}  // namespace fluxel

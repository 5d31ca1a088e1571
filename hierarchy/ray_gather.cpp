#include "hierarchy/ray_gather.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "core/sampling.hpp"
#include "hierarchy/emitter_view.hpp"

namespace fluxel {

namespace {

/// The weights of the two kinds of rays that may meet an emitter, whatever their numbers.
constexpr RayNumbers kBoth{4, 1};

/// Of each half of a point's rays: the first ones, which tell how many the other half needs, and the most.
constexpr int kPilots = 12, kLampPilots = 8, kMostRays = 4096;

/// As EmitterDraw takes lamps to be seen beforehand: rays without an answer, half of them free (Beta
/// distribution of 0.1 and 0.1).
constexpr double kPriorRays = 0.1;

/// Of a lamp that all pilots see, or none does: the standard deviation of whether one ray more sees it, the
/// root of the mean of p (1 - p), 0.1 (0.1 + n) / ((0.2 + n) (1.2 + n)), for n pilots.
constexpr double kUntold = 0.104;

/// How many: by comparing pictures of stairs; errors that are asked for are measured afterwards.
constexpr double kRaysOfNoise = 0.2;

/// Variance of a part's points over the squared length of a ray: above it the part is close.
constexpr double kClose = 0.2;
constexpr int kMaxBounces = 4;

constexpr std::size_t kPointsAtOnce = 4096;

/// The mean of samples that come one by one, and how they vary.
class Samples {
 public:
  void add(const Rgb& sample) {
    sum_ += sample;
    const double size = mean_of_colours(sample);
    sizes_ += size;
    squares_ += size * size;
    ++count_;
  }
  [[nodiscard]] Rgb mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : Rgb(0); }
  [[nodiscard]] int count() const { return count_; }
  /// The standard deviation of one sample.
  [[nodiscard]] double spread() const {
    return count_ > 1 ? std::sqrt(std::max(0.0, squares_ - sizes_ * sizes_ / count_) / (count_ - 1)) : 0;
  }

 private:
  Rgb sum_{0};
  double sizes_ = 0, squares_ = 0;
  int count_ = 0;
};

/// What rays may meet, and what of it is asked for.
struct MetLight {
  const RayLight& emitted;
  const SolutionLight& solution;
  Rgb scale;  ///< of what is reflected
  LightFrom from = LightFrom::everywhere;

  [[nodiscard]] bool asks_hemisphere() const { return from != LightFrom::emission; }
  [[nodiscard]] bool asks_lamps() const {
    return from != LightFrom::reflection && !emitted.emitters().empty();
  }
  [[nodiscard]] RayNumbers numbers() const { return asks_hemisphere() ? kBoth : RayNumbers{0, 1}; }
};

/// Rays from one point by one sequence of random numbers: over its hemisphere and to emitters.
class PointRays {
 public:
  /// `emitters`: as the point sees them, where it has many rays to them; null: it has few.
  PointRays(const MetLight& gathered, const ReceivingPoint& at, const EmitterView* emitters,
            std::uint64_t seed, int bounces)
      : gathered_(gathered),
        light_(gathered.emitted),
        at_(at),
        seed_(seed),
        bounces_(bounces),
        emitters_(emitters),
        directions_(seed),
        lamps_(random_bits(seed)) {}

  void trace_hemisphere(int until) {
    while (over_hemisphere_.count() < until) over_hemisphere_.add(of_hemisphere());
  }

  void trace_lamps(int until) {
    if (emitters_ != nullptr && emitters_->empty()) return;
    const std::uint32_t count = static_cast<std::uint32_t>(std::max(0, until - to_lamps_.count()));
    std::array<Rgb, RayPacket::kSize> found;
    for (std::uint32_t first = 0; first < count; first += RayPacket::kSize) {
      const std::uint32_t some = std::min<std::uint32_t>(RayPacket::kSize, count - first);
      found.fill(Rgb(0));
      RayLight::Lamps rays(light_, gathered_.numbers(),
                           [&found](std::uint32_t number, const Rgb& light) { found[number] = light; });
      for (std::uint32_t k = 0; k < some; ++k) {
        const auto [choice, u, v, unused] = lamps_.next();
        const OpenRay open = rays.point(k, at_, draw(choice, u, v));
        open_ += mean_of_colours(open.light);
        met_squares_ += open.met_square;
      }
      rays_ += rays.finish();
      for (std::uint32_t k = 0; k < some; ++k) {
        to_lamps_.add(found[k]);
        free_ += found[k] != Rgb(0) ? 1 : 0;
      }
    }
  }

  /// The standard deviation of one ray of the hemisphere. Few of them tell of lamps that rays to them see.
  [[nodiscard]] double hemisphere_spread() const {
    if (to_lamps_.count() == 0) return over_hemisphere_.spread();
    const double seen = (free_ + kPriorRays) / (to_lamps_.count() + 2 * kPriorRays);
    return std::max(over_hemisphere_.spread(), std::sqrt(seen * met_squares_ / to_lamps_.count()));
  }
  /// Likewise of a ray to a lamp, whose shadow may end here even where all of them say the same.
  [[nodiscard]] double lamp_spread() const {
    if (to_lamps_.count() == 0) return 0;
    return std::max(to_lamps_.spread(), kUntold * open_ / to_lamps_.count());
  }
  [[nodiscard]] Rgb irradiance() const { return over_hemisphere_.mean() + to_lamps_.mean(); }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  Rgb of_hemisphere() {
    const NodeTree& tree = light_.tree();
    const auto [u, v, unused, other] = directions_.next();
    const MetLeaf met = light_.first_met(at_, u, v);
    ++rays_;
    if (met.leaf == kNoNode) return Rgb(0);
    const Rgb emitted =
        gathered_.asks_lamps()
            ? static_cast<double>(kBoth.hemisphere) *
                  light_.emitted(at_, met, kBoth,
                                 [this](NodeId face, const glm::dvec3& of) { return density(face, of); })
            : Rgb(0);
    const glm::dvec3 way = met.point - at_.position;
    const EndLight end = gathered_.solution.at(met.leaf, met.point);
    const bool is_close = end.variance > kClose * glm::dot(way, way);
    if (!is_close || bounces_ == kMaxBounces) return emitted + gathered_.scale * end.reflected;
    const auto number = static_cast<std::uint64_t>(over_hemisphere_.count());
    MetLight everywhere = gathered_;
    everywhere.from = LightFrom::everywhere;
    PointRays onwards(everywhere, light_.receiving(met.leaf, met.point), nullptr,
                      random_bits(random_bits(seed_) + number + 1), bounces_ + 1);
    onwards.trace_hemisphere(1);
    if (everywhere.asks_lamps()) onwards.trace_lamps(1);
    rays_ += onwards.rays();
    return emitted + tree.material(met.leaf).rho * onwards.irradiance();
  }

  [[nodiscard]] DrawnEmitter draw(double choice, double u, double v) const {
    return emitters_ != nullptr ? emitters_->draw(choice, u, v) : light_.emitters().draw(at_, choice, u, v);
  }
  [[nodiscard]] double density(NodeId face, const glm::dvec3& of) const {
    return emitters_ != nullptr ? emitters_->density(face, of) : light_.emitters().density(face, of, at_);
  }

  const MetLight& gathered_;
  const RayLight& light_;
  ReceivingPoint at_;
  std::uint64_t seed_;
  int bounces_;
  const EmitterView* emitters_;
  SobolPoints directions_, lamps_;
  Samples over_hemisphere_, to_lamps_;
  // Of rays to lamps: that are free; sums of what OpenRay tells, mean of the colours.
  int free_ = 0;
  double open_ = 0, met_squares_ = 0;
  std::uint64_t rays_ = 0;
};

/// Irradiance by each half of a point's rays [W/m2].
using PointHalves = std::array<Rgb, 2>;

/// The irradiance of a point by two halves of its rays. What the first ones of each half vary by tells how
/// many the other gets: the more the brighter and the less even its surroundings are (Neyman 1934), and right
/// in the mean, which a number that depends on the very rays that it is of would not be. `rays_a_spread`: for
/// a spread of 1 W/m2.
PointHalves irradiance_of(const MetLight& light, const ReceivingPoint& at, double rays_a_spread,
                          std::uint64_t seed, std::uint64_t& rays) {
  std::optional<EmitterView> emitters;
  if (light.asks_lamps()) emitters.emplace(light.emitted.emitters(), at);
  const EmitterView* const seen = emitters ? &*emitters : nullptr;
  std::array halves{PointRays(light, at, seen, seed, 0), PointRays(light, at, seen, ~random_bits(seed), 0)};
  for (PointRays& half : halves) {
    half.trace_hemisphere(light.asks_hemisphere() ? kPilots : 0);
    half.trace_lamps(light.asks_lamps() ? kLampPilots : 0);
  }
  const auto wanted = [rays_a_spread](double spread_of_other) {
    return static_cast<int>(std::min<double>(kMostRays, rays_a_spread * spread_of_other));
  };
  const std::array hemisphere{wanted(halves[1].hemisphere_spread()), wanted(halves[0].hemisphere_spread())};
  const std::array lamps{wanted(halves[1].lamp_spread()), wanted(halves[0].lamp_spread())};
  PointHalves irradiance;
  for (std::size_t k = 0; k < halves.size(); ++k) {
    halves[k].trace_hemisphere(hemisphere[k]);
    halves[k].trace_lamps(lamps[k]);
    irradiance[k] = halves[k].irradiance();
    rays += halves[k].rays();
  }
  return irradiance;
}

}  // namespace

std::vector<Rgb> mean_of_halves(const std::array<std::vector<Rgb>, 2>& halves) {
  std::vector<Rgb> mean(halves[0].size());
  for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = 0.5 * (halves[0][k] + halves[1][k]);
  return mean;
}

std::array<std::vector<Rgb>, 2> RayGather::gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                                  const GatherCrew& crew, Progress& progress) {
  const double rays_a_spread =
      kRaysOfNoise / (goal.error * goal.error * std::max(mean_of_colours(goal.mean_radiosity), 1e-300));
  const MetLight light{emitted_, solution_, scale_, goal.light};
  const Ranks& ranks = crew.ranks;
  std::vector<PointHalves> own;
  for (std::size_t k = ranks.rank; k < points.size(); k += ranks.size) own.emplace_back();
  std::atomic<std::uint64_t> rays = 0;
  tbb::task_arena arena(crew.threads);
  for (std::size_t first = 0; first < points.size(); first += kPointsAtOnce * ranks.size) {
    const std::size_t from = first / ranks.size, to = std::min(own.size(), from + kPointsAtOnce);
    arena.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(from, to), [&](const auto& range) {
        std::uint64_t of_range = 0;
        for (std::size_t k = range.begin(); k < range.end() && !crew.is_stopped(); ++k) {
          const std::size_t number = k * ranks.size + ranks.rank;
          const GatherPoint& point = points[number];
          if (point.face == kNoNode) continue;
          const double rho = mean_of_colours(emitted_.tree().material(point.face).rho);
          own[k] = irradiance_of(light, emitted_.receiving(point.face, point.position),
                                 rho * point.weight * point.weight * rays_a_spread,
                                 random_bits(random_bits(goal.seed) + number), of_range);
        }
        rays += of_range;
      });
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

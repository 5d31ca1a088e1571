#include "hierarchy/point_rays.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "core/sampling.hpp"

namespace fluxel {

namespace {

/// Of each half of a point's rays: the first ones, which tell how many the other half needs, and the most.
constexpr int kPilots = 12, kLampPilots = 8, kMostRays = 4096;

/// As EmitterDraw takes lamps to be seen beforehand: rays without an answer, half of them free (Beta
/// distribution of 0.1 and 0.1).
constexpr double kPriorLampRays = 0.1;

/// Of a lamp that all pilots see, or none does: the standard deviation of whether one ray more sees it, the
/// root of the mean of p (1 - p), 0.1 (0.1 + n) / ((0.2 + n) (1.2 + n)), for n pilots.
constexpr double kUntold = 0.104;

/// Variance of a part's points over the squared length of a ray: above it the part is close.
constexpr double kClosePart = 0.2;
constexpr int kMaxPointBounces = 4;

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
    while (over_hemisphere_.count() < until) {
      const Ray ray = next_ray();
      take(light_.first_met(ray));
    }
  }
  /// How many rays of the hemisphere there have been.
  [[nodiscard]] int traced() const { return over_hemisphere_.count(); }
  /// The next rays of the hemisphere, to be traced elsewhere, and in the same order what they meet.
  void aim(std::span<Ray> rays) {
    for (Ray& ray : rays) ray = next_ray();
  }
  void take(std::span<const Ray> rays, std::span<const PatchHit> hits) {
    for (std::size_t k = 0; k < rays.size(); ++k) take(light_.end_of(rays[k], hits[k]));
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

  /// One ray to a luminaire that is drawn.
  void trace_luminaire() {
    of_luminaires_ =
        light_.luminaires().sampled_irradiance({at_.position, at_.normal}, 1, random_bits(~seed_), rays_);
  }

  /// The standard deviation of one ray of the hemisphere. Few of them tell of lamps that rays to them see.
  [[nodiscard]] double hemisphere_spread() const {
    if (to_lamps_.count() == 0) return over_hemisphere_.spread();
    const double seen = (free_ + kPriorLampRays) / (to_lamps_.count() + 2 * kPriorLampRays);
    return std::max(over_hemisphere_.spread(), std::sqrt(seen * met_squares_ / to_lamps_.count()));
  }
  /// Likewise of a ray to a lamp, whose shadow may end here even where all of them say the same.
  [[nodiscard]] double lamp_spread() const {
    if (to_lamps_.count() == 0) return 0;
    return std::max(to_lamps_.spread(), kUntold * open_ / to_lamps_.count());
  }
  [[nodiscard]] Rgb irradiance() const { return over_hemisphere_.mean() + to_lamps_.mean() + of_luminaires_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  [[nodiscard]] Ray next_ray() {
    const auto [u, v, unused, other] = directions_.next();
    return light_.hemisphere_ray(at_, u, v);
  }
  void take(const MetLeaf& met) {
    ++rays_;
    over_hemisphere_.add(brought_by(met));
  }
  Rgb brought_by(const MetLeaf& met) {
    const NodeTree& tree = light_.tree();
    if (met.leaf == kNoNode) return Rgb(0);
    const Rgb emitted =
        gathered_.asks_lamps()
            ? static_cast<double>(MetLight::kBoth.hemisphere) *
                  light_.emitted(at_, met, MetLight::kBoth,
                                 [this](NodeId face, const glm::dvec3& of) { return density(face, of); })
            : Rgb(0);
    const glm::dvec3 way = met.point - at_.position;
    const EndLight end = gathered_.solution.at(met.leaf, met.point);
    const bool is_close = end.variance > kClosePart * glm::dot(way, way);
    if (!is_close || bounces_ == kMaxPointBounces) return emitted + gathered_.scale * end.reflected;
    const auto number = static_cast<std::uint64_t>(over_hemisphere_.count());
    MetLight everywhere = gathered_;
    everywhere.from = LightFrom::everywhere;
    PointRays onwards(everywhere, light_.receiving(met.leaf, met.point), nullptr,
                      random_bits(random_bits(seed_) + number + 1), bounces_ + 1);
    onwards.trace_hemisphere(1);
    if (everywhere.asks_lamps()) onwards.trace_lamps(1);
    if (everywhere.asks_luminaires()) onwards.trace_luminaire();
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
  Rgb of_luminaires_{0};
  // Of rays to lamps: that are free; sums of what OpenRay tells, mean of the colours.
  int free_ = 0;
  double open_ = 0, met_squares_ = 0;
  std::uint64_t rays_ = 0;
};

}  // namespace

struct PointGather::State {
  const MetLight& light;
  double rays_a_spread;
  std::optional<EmitterView> emitters;
  std::array<PointRays, 2> halves;
  std::array<int, 2> hemisphere{}, lamps{};  // asked for: until there are so many
  std::array<Rgb, 2> of_luminaires{Rgb(0), Rgb(0)};
  std::uint64_t rays_to_luminaires = 0;

  State(const MetLight& of, const ReceivingPoint& at, double a_spread, std::uint64_t seed)
      : light(of),
        rays_a_spread(a_spread),
        emitters(of.asks_lamps() ? std::optional<EmitterView>(std::in_place, of.emitted.emitters(), at)
                                 : std::nullopt),
        halves{PointRays(of, at, seen(), seed, 0), PointRays(of, at, seen(), ~random_bits(seed), 0)} {
    if (of.asks_luminaires())
      of_luminaires = of.emitted.luminaires().irradiance_halves({at.position, at.normal}, a_spread,
                                                                random_bits(seed + 1), rays_to_luminaires);
  }

  [[nodiscard]] const EmitterView* seen() const { return emitters ? &*emitters : nullptr; }
  [[nodiscard]] int wanted(double spread_of_other) const {
    return static_cast<int>(std::min<double>(kMostRays, rays_a_spread * spread_of_other));
  }
  [[nodiscard]] std::size_t left(std::size_t half) const {
    return static_cast<std::size_t>(std::max(0, hemisphere[half] - halves[half].traced()));
  }
};

PointGather::PointGather(const MetLight& light, const ReceivingPoint& at, double rays_a_spread,
                         std::uint64_t seed)
    : state_(std::make_unique<State>(light, at, rays_a_spread, seed)) {}
PointGather::~PointGather() = default;

void PointGather::ask_pilots() {
  state_->hemisphere.fill(state_->light.asks_hemisphere() ? kPilots : 0);
  state_->lamps.fill(state_->light.asks_lamps() ? kLampPilots : 0);
}

void PointGather::ask_rest() {
  const auto& halves = state_->halves;
  for (std::size_t k = 0; k < halves.size(); ++k) {
    state_->hemisphere[k] = state_->wanted(halves[1 - k].hemisphere_spread());
    state_->lamps[k] = state_->wanted(halves[1 - k].lamp_spread());
  }
}

void PointGather::trace() {
  for (std::size_t k = 0; k < state_->halves.size(); ++k) {
    state_->halves[k].trace_hemisphere(state_->hemisphere[k]);
    state_->halves[k].trace_lamps(state_->lamps[k]);
  }
}

std::size_t PointGather::asked() const { return state_->left(0) + state_->left(1); }

void PointGather::aim(std::span<Ray> rays) {
  const std::size_t first = state_->left(0);
  state_->halves[0].aim(rays.first(first));
  state_->halves[1].aim(rays.subspan(first));
}

void PointGather::take(std::span<const Ray> rays, std::span<const PatchHit> hits) {
  const std::size_t first = state_->left(0);
  state_->halves[0].take(rays.first(first), hits.first(first));
  state_->halves[1].take(rays.subspan(first), hits.subspan(first));
  for (std::size_t k = 0; k < state_->halves.size(); ++k) state_->halves[k].trace_lamps(state_->lamps[k]);
}

std::array<Rgb, 2> PointGather::irradiance() const {
  return {state_->halves[0].irradiance() + state_->of_luminaires[0],
          state_->halves[1].irradiance() + state_->of_luminaires[1]};
}

std::uint64_t PointGather::rays() const {
  return state_->halves[0].rays() + state_->halves[1].rays() + state_->rays_to_luminaires;
}

}  // namespace fluxel

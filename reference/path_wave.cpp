#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "formfactor/free_segments.hpp"
#include "reference/cuda/path_rules.hpp"
#include "reference/light_paths.hpp"
#include "reference/onward_ways.hpp"

namespace fluxel {

namespace {

/// With a solution as control, paths of at least this weight go on.
constexpr double kSpared = 0.3;

}  // namespace

/// Paths that go on side by side, so that their rays are traced in packets.
class LightPaths::Wave {
 public:
  Wave(const LightPaths& paths, std::span<const PathStart> starts) : paths_(paths) {
    walks_.reserve(starts.size());
    alive_.reserve(starts.size());
    for (const PathStart& start : starts) {
      alive_.push_back(static_cast<std::uint32_t>(walks_.size()));
      walks_.push_back(
          {start.at, start.light, start.numbers, start.sight, start.sight.has_value(), start.is_indirect});
    }
  }

  /// Until all have ended.
  void trace() {
    for (; !alive_.empty(); ++met_before_) {
      // Weights of several guided rays would multiply.
      is_guided_ = paths_.guides_ && met_before_ == 0;
      light();
      if (!paths_.luminaires_.empty()) light_by_luminaires();
      if (paths_.luminaires_.makes_spots()) light_by_spots();
      go_on();
    }
  }

  [[nodiscard]] const Rgb& found(std::size_t k) const { return walks_[k].sum; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  struct Walk {
    LitPoint at;
    std::array<double, 2> light;  ///< for the next point of an emitter
    OwenSobol numbers;
    std::optional<glm::dvec3> straight;  ///< unit: the only direction from which light counts
    bool is_sight;                       ///< it has met nothing yet that scatters light evenly
    bool is_indirect;                    ///< what emits brings nothing until a surface has scattered it
    Rgb sum{0}, weight{1};
    bool is_scattered = false;  ///< it comes from a surface that scatters evenly, whose spots were its light
    double compression = 1;     ///< in the weight, which says nothing of what is kept of the power
  };

  [[nodiscard]] bool leaves_out_emitters(const Walk& walk) const { return walk.is_indirect; }

  /// Adds what a point of an emitter brings to where each path is. Where one direction alone counts no point
  /// that is drawn lies in it.
  void light() {
    RayPacket packet;
    std::array<std::uint32_t, RayPacket::kSize> walks;
    std::array<Rgb, RayPacket::kSize> brought;
    std::size_t count = 0;
    const auto trace_packet = [&] {
      const std::uint32_t hidden = paths_.ray_scene_.occluded(packet, static_cast<int>(count));
      for (std::size_t k = 0; k < count; ++k)
        if ((hidden >> k & 1u) == 0) walks_[walks[k]].sum += brought[k];
      rays_ += count;
      count = 0;
    };
    for (const std::uint32_t k : alive_) {
      const Walk& walk = walks_[k];
      if (walk.straight || leaves_out_emitters(walk)) continue;
      const auto lit = paths_.lit_by(walk.at, walk.light, is_guided_);
      if (!lit) continue;
      // From the emitter: what single precision rounds off a receiver that is far away must not move the end
      // that lies on a surface.
      packet.set_segment(static_cast<int>(count), glm::vec3(lit->from), glm::vec3(paths_.lifted(walk.at)));
      walks[count] = k;
      brought[count] = walk.weight * lit->light;
      if (++count == walks.size()) trace_packet();
    }
    if (count > 0) trace_packet();
  }

  /// Adds what a point of a luminaire brings to where each path is. Of other rays only those find luminaires
  /// that surfaces have sent on straight.
  void light_by_luminaires() {
    segments_.clear();
    brought_.clear();
    for (const std::uint32_t k : alive_) {
      Walk& walk = walks_[k];
      if (walk.straight || leaves_out_emitters(walk)) continue;
      const auto [choice, u, v, unused] = walk.numbers.next();
      const LuminaireRay ray = paths_.luminaires_.draw({walk.at.position, walk.at.normal}, choice, u, v);
      if (ray.light == Rgb(0)) continue;
      if (walk.is_scattered && glm::distance(ray.from, walk.at.position) < ray.reach) continue;
      segments_.push_back({ray.from, ray.normal, walk.at.position, walk.at.normal});
      brought_.push_back({k, walk.weight * ray.light});
    }
    add_free();
  }

  /// Adds what a spot that a luminaire makes on a surface close to it brings to where each path is: the ray
  /// of the luminaire finds it, as a path that goes on hardly does (Lafortune & Willems 1993 have all such
  /// pairs of paths).
  void light_by_spots() {
    next_rays_.clear();
    spots_.clear();
    for (const std::uint32_t k : alive_) {
      Walk& walk = walks_[k];
      if (walk.straight) continue;
      const double choice = walk.numbers.next_random();
      const SpotRay drawn = paths_.luminaires_.draw_to_spot(choice, walk.numbers.next());
      next_rays_.push_back({drawn.ray.from, drawn.ray.direction});
      spots_.push_back({k, drawn.power, drawn.reach});
    }
    seen_.resize(next_rays_.size());
    paths_.first_seen(next_rays_, seen_);
    rays_ += next_rays_.size();
    segments_.clear();
    brought_.clear();
    for (std::size_t s = 0; s < spots_.size(); ++s) {
      const Seen& met = seen_[s];
      if (!met.is_active() || !(glm::distance(met.at.position, next_rays_[s].origin) < spots_[s].reach))
        continue;
      const Walk& walk = walks_[spots_[s].walk];
      const double kernel =
          cuda::kernel_between(walk.at.position, walk.at.normal, met.at.position, met.at.normal);
      if (!(kernel > 0)) continue;
      segments_.push_back({met.at.position, met.at.normal, walk.at.position, walk.at.normal});
      brought_.push_back({spots_[s].walk, walk.weight * met.side->rho * spots_[s].power * kernel});
    }
    add_free();
  }

  /// Adds what comes along the segments that nothing stands in.
  void add_free() {
    for (std::size_t first = 0; first < segments_.size(); first += RayPacket::kSize) {
      const auto some = std::span(segments_).subspan(
          first, std::min<std::size_t>(RayPacket::kSize, segments_.size() - first));
      const std::uint32_t free = free_segments(paths_.ray_scene_, some);
      for (std::size_t k = 0; k < some.size(); ++k)
        if ((free >> k & 1u) != 0) walks_[brought_[first + k].walk].sum += brought_[first + k].light;
    }
    rays_ += segments_.size();
  }

  /// Traces each path's next ray.
  void go_on() {
    rays_ += alive_.size();
    headings_.clear();
    next_rays_.clear();
    std::size_t ahead = 0;
    for (const std::uint32_t k : alive_) {
      const auto to = heading(walks_[k]);
      if (!to) continue;
      headings_.push_back(*to);
      next_rays_.push_back({paths_.lifted(walks_[k].at), to->direction});
      alive_[ahead++] = k;
    }
    seen_.resize(ahead);
    paths_.first_seen(next_rays_, seen_);
    std::size_t going = 0;
    for (std::size_t k = 0; k < ahead; ++k)
      if (arrives(walks_[alive_[k]], next_rays_[k], headings_[k], seen_[k])) alive_[going++] = alive_[k];
    alive_.resize(going);
  }

  /// Of a path's next ray; none: the path ends.
  [[nodiscard]] std::optional<Heading> heading(Walk& walk) const {
    if (walk.straight) return Heading{*walk.straight, {}};
    const auto [u, v, next_u, next_v] = walk.numbers.next();
    walk.light = {next_u, next_v};
    return paths_.heading(walk.at, u, v, is_guided_);
  }

  /// Adds what a path's ray has met. Returns whether the path goes on from there.
  bool arrives(Walk& walk, const Ray& ray, const Heading& to, const Seen& met) const {
    if (walk.straight) {
      if (!shines_straight(walk, ray, met)) return false;
    } else {
      const auto next = paths_.next(walk.at, to, met, is_guided_);
      if (!next) return false;
      if (is_guided_) walk.weight *= next->density > 0 ? next->kernel / next->density : 0;
      if (const double drawn = paths_.emitters_.density(met.side->E); drawn > 0 && !leaves_out_emitters(walk))
        walk.sum += walk.weight * met.side->E * cuda::share_of_met(next->density, drawn);
    }
    const FinishedLight* finished = paths_.finished_;
    const auto of_solution = [&] {
      return walk.weight * finished->reflected(met.patch, met.front, met.at.position);
    };
    const bool is_controlled = finished != nullptr;
    const Rgb reflected = walk.weight * met.side->rho;
    std::optional<OnwardWays> ways;  // none: evenly alone, as from most sides
    if (!met.side->is_diffuse())
      ways.emplace(*met.side, MetPoint{met.at, met.front, to.direction}, walk.weight);
    // What is seen first is always followed, as where it is diffuse.
    const bool is_first = walk.straight && met_before_ == 0;
    const double kept = (ways ? ways->all() : largest_colour(reflected)) / walk.compression;
    const double survival =
        is_first ? 1 : std::min(cuda::kMaxSurvival, kept / (is_controlled ? kSpared : 1.0));
    const double number = walk.numbers.next_random();
    const bool goes_on = kept > 0 && number < survival;
    // On average of both ends nothing is added.
    if (is_controlled) walk.sum += (goes_on ? 1 - 1 / survival : 1.0) * of_solution();
    if (goes_on) {
      const bool comes_evenly = !walk.straight;
      turn(walk, ways ? ways->chosen(number / survival) : Onward{.at = met.at, .weight = reflected},
           survival);
      walk.is_scattered = comes_evenly && walk.at.normal == met.at.normal;
    }
    return goes_on;
  }

  /// Adds the light of what a straight ray has met, of which no point was drawn. Returns whether it was a
  /// surface that may send light.
  bool shines_straight(Walk& walk, const Ray& ray, const Seen& met) const {
    if (!walk.is_sight && !walk.is_indirect && !paths_.openings_.empty()) {
      const double end = met.side != nullptr ? glm::dot(met.at.position - ray.origin, ray.direction)
                                             : std::numeric_limits<double>::infinity();
      walk.sum += walk.weight * (std::numbers::pi * paths_.openings_.radiance(ray, end));
    }
    if (!met.is_active()) return false;
    if (!walk.is_indirect) walk.sum += walk.weight * met.side->E;
    return true;
  }

  static void turn(Walk& walk, const Onward& onward, double survival) {
    walk.at = onward.at;
    walk.weight = onward.weight / survival;
    walk.compression *= onward.compression;
    walk.straight.reset();
    if (onward.is_straight)
      walk.straight = onward.direction;
    else
      walk.is_sight = walk.is_indirect = false;
  }

  const LightPaths& paths_;
  std::vector<Walk> walks_;
  std::vector<std::uint32_t> alive_;  ///< numbers of the paths that go on, ascending
  int met_before_ = 0;
  bool is_guided_ = false;
  std::uint64_t rays_ = 0;
  // Of a bounce, of each path that a luminaire may light.
  struct Brought {
    std::uint32_t walk = 0;
    Rgb light{0};
  };
  struct DrawnSpot {
    std::uint32_t walk = 0;
    Rgb power{0};
    double reach = 0;
  };
  std::vector<DrawnSpot> spots_;
  std::vector<SurfaceSegment> segments_;
  std::vector<Brought> brought_;
  // Of a bounce, of each path that has a next ray.
  std::vector<Heading> headings_;
  std::vector<Ray> next_rays_;
  std::vector<Seen> seen_;
};

void LightPaths::irradiance(std::span<const PathStart> starts, std::span<Rgb> found,
                            std::uint64_t& rays) const {
  Wave wave(*this, starts);
  wave.trace();
  for (std::size_t k = 0; k < starts.size(); ++k) found[k] = wave.found(k);
  rays += wave.rays();
}

}  // namespace fluxel

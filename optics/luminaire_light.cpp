#include "optics/luminaire_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "formfactor/free_segments.hpp"
#include "optics/luminaire_intensity.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

namespace {

/// Of an opening, or of the luminaires that bring little: the first rays of each half, and the most.
constexpr std::size_t kFirstRays = 4, kMostRays = 1024;

/// Of openings that all first rays see, or none does: the standard deviation of whether one ray more sees
/// them, as PointGather takes lamps to be seen beforehand, the root of 0.1 (0.1 + n) / ((0.2 + n) (1.2 + n)).
constexpr double kUntold = 0.137;

/// Luminaires that are expected to bring less than this of the whole are drawn from together.
constexpr double kLittle = 1.0 / 64;

/// Luminaires of which each is asked what it sends to a place.
constexpr std::size_t kFew = 64;

/// Points of an opening, along an axis of it, are no farther from each other than this share of its distance
/// from the place, as their irradiance is then that of the whole; and no more than so many.
constexpr double kSpacing = 0.5;
constexpr int kMostAlong = 32;

/// Luminaires light a spot where a part of their rays meets a surface nearer than this: of an opening so many
/// of its sizes; of a point that is close so many times the distance of the nearest surface, or that part of
/// the farthest's. Rays by which that is looked for.
constexpr double kSpotOfOpening = 0.1, kSpotOfPoint = 256, kLargestSpot = 0.02, kPartOfSpot = 1e-2;
constexpr int kSpotRays = 512;

/// A point is close where the nearest surface is, over what nine tenths of its rays reach, or over what the
/// farthest does.
constexpr double kCloseOfMost = 0.01, kCloseOfFarthest = 1e-3, kMostOfRays = 0.9;

/// Where an opening is near, parts of it may be seen that its centre says nothing of.
constexpr double kOfMean = 0.1;

/// The size of light that rays bring, one by one.
class Spread {
 public:
  void add(double size) {
    sum_ += size;
    squares_ += size * size;
    ++count_;
  }
  [[nodiscard]] double of_one() const {
    return count_ > 1 ? std::sqrt(std::max(0.0, squares_ - sum_ * sum_ / count_) / (count_ - 1)) : 0;
  }

 private:
  double sum_ = 0, squares_ = 0;
  int count_ = 0;
};

/// Rays to one place, traced in packets.
class ToPlace {
 public:
  ToPlace(const RayScene& ray_scene, const LitPlace& at) : ray_scene_(ray_scene), at_(at) {}

  /// Adds what is seen of the rays. `spread`: gets what each brings.
  Rgb visible(std::span<const LuminaireRay> rays, Spread* spread = nullptr) {
    Rgb sum(0);
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    std::array<const LuminaireRay*, RayPacket::kSize> waiting;
    std::size_t count = 0;
    const auto trace = [&] {
      const std::uint32_t free = free_segments(ray_scene_, std::span(segments).first(count));
      traced_ += count;
      for (std::size_t k = 0; k < count; ++k) {
        const Rgb light = (free >> k & 1u) != 0 ? waiting[k]->light : Rgb(0);
        sum += light;
        if (spread != nullptr) spread->add(mean_of_colours(light));
      }
      count = 0;
    };
    for (const LuminaireRay& ray : rays) {
      if (ray.light == Rgb(0)) {
        if (spread != nullptr) spread->add(0);
        continue;
      }
      segments[count] = {ray.from, ray.normal, at_.position, at_.normal};
      waiting[count] = &ray;
      if (++count == segments.size()) trace();
    }
    if (count > 0) trace();
    return sum;
  }
  [[nodiscard]] std::uint64_t traced() const { return traced_; }

 private:
  const RayScene& ray_scene_;
  LitPlace at_;
  std::uint64_t traced_ = 0;
};

/// Of distances that ascend; 0 where the nearest surface is not close.
double reach_of_point(std::span<const double> distances) {
  const double nearest = distances.front(), farthest = distances.back();
  const double usual =
      distances[static_cast<std::size_t>(kMostOfRays * static_cast<double>(distances.size()))];
  const bool is_close = nearest < kCloseOfMost * usual || nearest < kCloseOfFarthest * farthest;
  return is_close ? std::min(kSpotOfPoint * nearest, kLargestSpot * farthest) : 0;
}

}  // namespace

LuminaireLight::LuminaireLight(const RayScene& ray_scene)
    : ray_scene_(ray_scene), emitters_(emitters_of(ray_scene.scene())), tree_(tree_of(emitters_)) {
  for (const Emitter& emitter : emitters_) flux_ += fluxel::flux(*emitter.table) * emitter.luminaire->scale;
  if (emitters_.size() <= kFew) find_spots();
}

void LuminaireLight::find_spots() {
  const FirstSide first_side(ray_scene_);
  for (std::size_t number = 0; number < emitters_.size(); ++number) {
    Emitter& emitter = emitters_[number];
    const Luminaire& of = *emitter.luminaire;
    LuminaireEmission emission(of, *emitter.table);
    SobolPoints points(number);
    std::vector<double> distances;
    for (int k = 0; k < kSpotRays; ++k) {
      const EmittedRay ray = emission.ray(points.next(), static_cast<double>(ray_scene_.surface_epsilon()));
      const MetSide met = first_side.meet(ray.from, ray.direction);
      if (met.patch != kNoPatch && met.active) distances.push_back(met.t);
    }
    if (distances.empty()) continue;
    std::ranges::sort(distances);
    const double reach =
        emitter.reach > 0 ? kSpotOfOpening * std::max(of.size.x, of.size.y) : reach_of_point(distances);
    const auto near = std::ranges::lower_bound(distances, reach) - distances.begin();
    if (static_cast<double>(near) < kPartOfSpot * kSpotRays) continue;
    emitter.spot = reach;
    const Rgb power = fluxel::flux(*emitter.table) * of.scale;
    const double before = spots_.empty() ? 0 : spots_.back().end;
    spots_.push_back({std::move(emission), power, reach, before + mean_of_colours(power)});
  }
}

SpotRay LuminaireLight::draw_to_spot(double choice, const std::array<double, 4>& numbers) const {
  const double whole = spots_.back().end;
  const auto found = std::ranges::upper_bound(spots_, choice * whole, {}, &Spot::end);
  const Spot& spot = found == spots_.end() ? spots_.back() : *found;
  return {spot.emission.ray(numbers, static_cast<double>(ray_scene_.surface_epsilon())),
          spot.power * (whole / mean_of_colours(spot.power)), spot.reach};
}

std::vector<LuminaireLight::Emitter> LuminaireLight::emitters_of(const Scene& scene) {
  std::vector<Emitter> emitters;
  for (const Luminaire& luminaire : scene.luminaires) {
    const IntensityTable& table = scene.intensity(luminaire);
    const double whole = fluxel::flux(table), scale = mean_of_colours(luminaire.scale);
    if (!(whole * scale > 0)) continue;
    emitters.push_back({&luminaire, &table, glm::cross(luminaire.ahead, luminaire.aim),
                        0.5 * glm::length(luminaire.size), scale * whole / (4 * std::numbers::pi),
                        scale * largest_intensity(table), 0});
  }
  return emitters;
}

LuminaireTree LuminaireLight::tree_of(std::span<const Emitter> emitters) {
  std::vector<LuminairePlace> places;
  for (const Emitter& emitter : emitters) {
    const Luminaire& of = *emitter.luminaire;
    const glm::dvec3 half = 0.5 * (of.size.x * glm::abs(of.ahead) + of.size.y * glm::abs(emitter.across));
    places.push_back({of.position - half, of.position + half, emitter.mean});
  }
  return LuminaireTree(places);
}

LuminaireRay LuminaireLight::ray_of(const Emitter& emitter, const LitPlace& at, double u, double v) const {
  const Luminaire& of = *emitter.luminaire;
  LuminaireRay ray;
  ray.from = opening_point(of, u, v);
  const glm::dvec3 way = at.position - ray.from;
  const double squared = glm::dot(way, way), along = glm::dot(way, of.aim), in = -glm::dot(way, at.normal);
  ray.normal = along < 0 ? -of.aim : of.aim;
  ray.reach = emitter.spot;
  if (!(in > 0) || !(squared > 0)) return ray;
  const double distance = std::sqrt(squared);
  const double towards = intensity_along(way, distance, of, emitter.across, *emitter.table);
  ray.light = of.scale * (towards * in / (distance * squared));
  return ray;
}

double LuminaireLight::distance(const Emitter& emitter, const glm::dvec3& at) {
  const Luminaire& of = *emitter.luminaire;
  const glm::dvec3 way = at - of.position;
  const glm::dvec2 beside = glm::max(
      glm::abs(glm::dvec2(glm::dot(way, of.ahead), glm::dot(way, emitter.across))) - 0.5 * of.size, 0.0);
  return std::hypot(beside.x, beside.y, glm::dot(way, of.aim));
}

double LuminaireLight::distance(const glm::dvec3& at) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Emitter& emitter : emitters_) least = std::min(least, distance(emitter, at));
  return least;
}

/// Irradiance over intensity where nothing stands in between [1/m2]: of a point cosine over squared distance,
/// of an opening about that, and above 0 wherever a part of it is in front of the place.
double LuminaireLight::geometric_factor(const Emitter& emitter, const LitPlace& at) {
  const glm::dvec3 way = emitter.luminaire->position - at.position;
  const double squared = glm::dot(way, way) + emitter.reach * emitter.reach;
  const double along = glm::dot(way, at.normal) + emitter.reach;
  if (!(along > 0)) return 0;
  return std::min(along / std::sqrt(squared), 1.0) / squared;
}

/// About what it brings where nothing stands in between, mean of the colours; above 0 wherever it may bring
/// anything.
double LuminaireLight::expected(const Emitter& emitter, const LitPlace& at, double geometric_factor) const {
  if (emitter.reach == 0) return mean_of_colours(ray_of(emitter, at, 0.5, 0.5).light);
  if (!(geometric_factor > 0)) return 0;
  const glm::dvec3 way = emitter.luminaire->position - at.position;
  const LuminaireRay centre = ray_of(emitter, {at.position, glm::normalize(way)}, 0.5, 0.5);
  const double towards = mean_of_colours(centre.light) * glm::dot(way, way);
  return (towards + kOfMean * emitter.mean) * geometric_factor;
}

double LuminaireLight::expected(const Emitter& emitter, const LitPlace& at) const {
  return expected(emitter, at, geometric_factor(emitter, at));
}

LuminaireLight::Draw LuminaireLight::all_at(const LitPlace& at) const {
  std::vector<double> factors;
  double whole = 0;
  for (const Emitter& emitter : emitters_) {
    factors.push_back(geometric_factor(emitter, at));
    whole += emitter.mean * factors.back();
  }
  // Of many the tables are asked only where one may matter; the others are as if they sent alike to all
  // sides.
  const double least = emitters_.size() > kFew ? kLittle * whole : 0;
  Draw draw;
  double sum = 0;
  for (std::size_t k = 0; k < emitters_.size(); ++k) {
    const Emitter& emitter = emitters_[k];
    const bool may_matter = emitter.most * factors[k] >= least;
    const double weight = may_matter ? expected(emitter, at, factors[k]) : emitter.mean * factors[k];
    if (!(weight > 0)) continue;
    draw.numbers.push_back(static_cast<std::uint32_t>(k));
    draw.ends.push_back(sum += weight);
  }
  return draw;
}

LuminaireRay LuminaireLight::drawn(const Draw& draw, const LitPlace& at, double choice, double u,
                                   double v) const {
  if (draw.ends.empty()) return {};
  const double whole = draw.ends.back();
  const auto found = std::ranges::upper_bound(draw.ends, choice * whole);
  const auto k = static_cast<std::size_t>(std::min(found, draw.ends.end() - 1) - draw.ends.begin());
  const double share = draw.ends[k] - (k > 0 ? draw.ends[k - 1] : 0);
  LuminaireRay ray = ray_of(emitters_[draw.numbers[k]], at, u, v);
  ray.light *= whole / share;
  return ray;
}

LuminaireRay LuminaireLight::draw(const LitPlace& at, double choice, double u, double v) const {
  // One pass without memory, as every vertex of a path asks: each luminaire takes the place of the one before
  // by its share of those so far, and what is left of the number is uniform again (Chao 1982).
  const LuminaireTree::Group group = tree_.draw(at, choice);
  choice = group.choice;
  const Emitter* chosen = nullptr;
  double whole = 0, of_chosen = 0;
  for (const std::uint32_t k : group.members) {
    const Emitter& emitter = emitters_[k];
    const double weight = expected(emitter, at);
    if (!(weight > 0)) continue;
    whole += weight;
    const double share = weight / whole;
    if (choice < share || chosen == nullptr) {
      chosen = &emitter;
      of_chosen = weight;
      choice /= share;
    } else {
      choice = (choice - share) / (1 - share);
    }
  }
  if (chosen == nullptr) return {};
  LuminaireRay ray = ray_of(*chosen, at, u, v);
  ray.light *= whole / (of_chosen * group.chance);
  return ray;
}

/// A lattice over the opening, moved within its meshes: as many points at least, and more where the place is
/// near.
void LuminaireLight::add_rays(const Emitter& emitter, const LitPlace& at, std::size_t least,
                              const glm::dvec2& shift, std::vector<LuminaireRay>& rays) const {
  if (emitter.reach == 0) {
    rays.push_back(ray_of(emitter, at, 0.5, 0.5));
    return;
  }
  const Luminaire& of = *emitter.luminaire;
  const double spacing =
      std::max(kSpacing * distance(emitter, at.position), std::numeric_limits<double>::min());
  // A disc's axes are the square of its radius and its circumference.
  const glm::dvec2 lengths = of.round ? of.size * glm::dvec2(1, std::numbers::pi) : of.size;
  const auto steps = [&](double length) {
    return static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, static_cast<double>(kMostAlong)));
  };
  glm::ivec2 count(steps(lengths.x), steps(lengths.y));
  while (static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) < least)
    ++(lengths.x / count.x > lengths.y / count.y ? count.x : count.y);
  const double share = 1.0 / (count.x * count.y);
  for (int i = 0; i < count.x; ++i)
    for (int j = 0; j < count.y; ++j) {
      rays.push_back(ray_of(emitter, at, (i + shift.x) / count.x, (j + shift.y) / count.y));
      rays.back().light *= share;
    }
}

Rgb LuminaireLight::sampled_irradiance(const LitPlace& at, std::size_t draws, std::uint64_t seed,
                                       std::uint64_t& traced) const {
  if (empty()) return Rgb(0);
  SobolPoints points(seed);
  std::vector<LuminaireRay> rays;
  if (emitters_.size() <= draws) {
    for (const Emitter& emitter : emitters_) {
      const auto [along_u, along_v, unused, other] = points.next();
      const glm::dvec2 shift = seed == 0 ? glm::dvec2(0.5) : glm::dvec2(along_u, along_v);
      add_rays(emitter, at, draws / emitters_.size(), shift, rays);
    }
  } else {
    const Draw all = all_at(at);
    for (std::size_t k = 0; k < draws; ++k) {
      const auto [u, v, choice, unused] = points.next();
      rays.push_back(drawn(all, at, choice, u, v));
      rays.back().light /= static_cast<double>(draws);
    }
  }
  ToPlace to(ray_scene_, at);
  const Rgb sum = to.visible(rays);
  traced += to.traced();
  return sum;
}

std::array<Rgb, 2> LuminaireLight::irradiance_halves(const LitPlace& at, double rays_a_spread,
                                                     std::uint64_t seed, std::uint64_t& traced) const {
  if (empty()) return {Rgb(0), Rgb(0)};
  const Draw all = all_at(at);
  Draw little;
  ToPlace to(ray_scene_, at);
  std::vector<LuminaireRay> rays, of_points;
  std::array<Rgb, 2> sums{Rgb(0), Rgb(0)};
  // Sampled: one luminaire, or those that bring little.
  const auto sample = [&](std::uint64_t number, double most, const auto& ray_at) {
    std::array<SobolPoints, 2> points{SobolPoints(random_bits(seed + number)),
                                      SobolPoints(~random_bits(seed + number))};
    std::array<Spread, 2> spreads;
    std::array<Rgb, 2> found{Rgb(0), Rgb(0)};
    std::array<std::size_t, 2> counts{};
    const auto trace = [&](std::size_t half, std::size_t until) {
      if (until <= counts[half]) return;
      rays.clear();
      for (; counts[half] < until; ++counts[half]) rays.push_back(ray_at(points[half].next()));
      found[half] += to.visible(rays, &spreads[half]);
    };
    for (std::size_t half = 0; half < 2; ++half) trace(half, kFirstRays);
    std::array<std::size_t, 2> wanted{};
    for (std::size_t half = 0; half < 2; ++half) {
      const double spread = std::max(spreads[1 - half].of_one(), kUntold * most);
      wanted[half] =
          static_cast<std::size_t>(std::min(static_cast<double>(kMostRays), rays_a_spread * spread));
    }
    for (std::size_t half = 0; half < 2; ++half) {
      trace(half, wanted[half]);
      sums[half] += found[half] / static_cast<double>(counts[half]);
    }
  };
  double before = 0, of_little = 0;
  for (std::size_t k = 0; k < all.numbers.size(); ++k) {
    const double weight = all.ends[k] - before;
    before = all.ends[k];
    const Emitter& emitter = emitters_[all.numbers[k]];
    if (weight < kLittle * all.ends.back()) {
      little.numbers.push_back(all.numbers[k]);
      little.ends.push_back(of_little += weight);
    } else if (emitter.reach == 0) {
      of_points.push_back(ray_of(emitter, at, 0.5, 0.5));
    } else {
      sample(all.numbers[k] + 1, weight, [&](const std::array<double, SobolPoints::kAxes>& numbers) {
        return ray_of(emitter, at, numbers[0], numbers[1]);
      });
    }
  }
  if (!little.numbers.empty())
    sample(0, of_little, [&](const std::array<double, SobolPoints::kAxes>& numbers) {
      return drawn(little, at, numbers[2], numbers[0], numbers[1]);
    });
  const Rgb exact = to.visible(of_points);
  for (Rgb& sum : sums) sum += exact;
  traced += to.traced();
  return sums;
}

}  // namespace fluxel

#include "method/round_samples.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "method/relative_error.hpp"

namespace fluxel {

void RoundSamples::take(double ray_error, std::uint64_t seed) {
  before_ = std::exchange(last_, {});
  if (probes_.empty()) {
    const NodeTree& tree = hierarchy_.tree();
    const std::vector<Rgb> B = of_all_nodes();
    for (std::size_t id = tree.clusters(); id < tree.size(); ++id)
      if (tree[static_cast<NodeId>(id)].is_leaf()) {
        last_.nodes.push_back(static_cast<NodeId>(id));
        last_.B.push_back(B[id]);
      }
    return;
  }
  last_.ray_error = ray_error;
  const std::vector<Rgb> other = gather(probes_, ray_error, seed + 2);
  last_.B = gather(probes_, ray_error, seed + 1);
  last_.noise = mean_square(last_.B, other) / 4.0;
  for (std::size_t k = 0; k < other.size(); ++k) last_.B[k] = 0.5 * (last_.B[k] + other[k]);
}

void RoundSamples::scale_reflected(const Rgb& scale) {
  hierarchy_.scale_reflected(Rgb(0));
  const std::vector<Rgb> of_emitters = gather(probes_, kForScale * last_.ray_error, 0);
  for (std::size_t k = 0; k < of_emitters.size(); ++k)
    last_.B[k] = of_emitters[k] + scale * (last_.B[k] - of_emitters[k]);
  // No more than there is for certain, as it is taken off.
  last_.noise *= glm::min(Rgb(1), scale * scale);
  hierarchy_.scale_reflected(scale);
}

std::optional<double> RoundSamples::change() const {
  const Rgb mean = this->mean();
  if (before_.B.empty() || !(mean_of_colours(mean) > 0)) return std::nullopt;
  const std::vector<Rgb> of_nodes = probes_.empty() ? of_all_nodes() : std::vector<Rgb>{};
  Rgb squares(0);
  double area = 0;
  for (std::size_t k = 0; k < before_.B.size(); ++k) {
    const double weight = probes_.empty() ? hierarchy_.tree()[before_.nodes[k]].shape.area : 1;
    const Rgb now = probes_.empty() ? of_nodes[before_.nodes[k]] : last_.B[k];
    const Rgb d = now - before_.B[k];
    squares += weight * d * d;
    area += weight;
  }
  // Rays of one round are not those of the other. Some of the change is never noise.
  constexpr double kNeverNoise = 0.05;
  const Rgb square = squares / area;
  return root_over_mean(glm::max(kNeverNoise * square, square - before_.noise - last_.noise), mean);
}

Rgb RoundSamples::mean() const {
  Rgb sum(0);
  if (!probes_.empty())
    for (const Rgb& B : last_.B) sum += B;
  if (!(mean_of_colours(sum) > 0)) return hierarchy_.mean_radiosity();
  return sum / static_cast<double>(last_.B.size());
}

std::optional<double> RoundSamples::ray_error_for(double noise) const {
  const Rgb mean = this->mean();
  if (!(mean_of_colours(mean) > 0)) return std::nullopt;
  const double of_one = root_over_mean(2.0 * last_.noise, mean);
  return of_one > 0 ? std::optional(last_.ray_error * noise / of_one) : std::nullopt;
}

SettledRays RoundSamples::settle(double ray_error, std::optional<double> allowed) const {
  SettledRays rays{ray_error, std::nullopt};
  const Rgb mean = this->mean();
  // Where there are many probes a part of them tells the noise.
  constexpr std::size_t kEnough = 256, kEvery = 4;
  std::vector<GatherPoint> some;
  for (std::size_t k = 0; k < probes_.size(); k += probes_.size() < kEvery * kEnough ? 1 : kEvery)
    some.push_back(probes_[k]);
  // Pictures of links are as good as their rays are here; those by rays are measured themselves.
  const double aim = hierarchy_.by_rays() ? 0.95 : 0.8;
  for (int k = 0; k < 3 && mean_of_colours(mean) > 0; ++k) {
    const Rgb square = mean_square(gather(some, rays.error, 1), gather(some, rays.error, 2)) / 2.0;
    rays.noise = root_over_mean(square, mean);
    if (!allowed || *rays.noise <= *allowed) break;
    const double finer = rays.error * std::max(0.2, aim * *allowed / *rays.noise);
    if (!limit_.has_time_for(2.0 * static_cast<double>(some.size()), finer)) break;
    rays.error = finer;
  }
  return rays;
}

std::vector<Rgb> RoundSamples::of_all_nodes() const {
  return of_heat_ ? hierarchy_.irradiance_of_nodes() : hierarchy_.radiosity_of_nodes();
}

/// Radiosity at probes without their own emission.
std::vector<Rgb> RoundSamples::gather(std::span<const GatherPoint> probes, double ray_error,
                                      std::uint64_t seed) const {
  SilentProgress silent;
  const double start = limit_.seconds();
  std::vector<Rgb> B = hierarchy_.gather(probes, {ray_error, hierarchy_.mean_radiosity(), seed}, silent);
  limit_.add_gather(ray_error, (limit_.seconds() - start) / static_cast<double>(probes.size()));
  for (std::size_t k = 0; k < B.size(); ++k) B[k] *= hierarchy_.tree().material(probes[k].face).rho;
  return B;
}

}  // namespace fluxel

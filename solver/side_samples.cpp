#include "solver/side_samples.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace fluxel {

std::vector<SideSample> choose_sides(const Unknowns& unknowns, std::span<const Rgb> B) {
  std::vector<SideSample> samples;
  if (unknowns.active <= kSampledSides) {
    for (std::size_t k = 0; k < unknowns.size(); ++k)
      if (unknowns.area[k] > 0) samples.push_back({static_cast<std::uint32_t>(k)});
    return samples;
  }
  const auto power = [&](std::size_t k) { return unknowns.area[k] * mean_of_colours(glm::abs(B[k])); };
  double whole_area = 0, whole_power = 0;
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    whole_area += unknowns.area[k];
    whole_power += power(k);
  }
  const double of_power = whole_power > 0 && std::isfinite(whole_power) ? 0.5 : 0;
  double sum = 0;
  std::uint32_t next = 0;  // draw, each in the middle of its part
  for (std::size_t k = 0; k < unknowns.size() && next < kSampledSides; ++k) {
    const double share = (1 - of_power) * unknowns.area[k] / whole_area +
                         (of_power > 0 ? of_power * power(k) / whole_power : 0);
    sum += share;
    std::uint32_t draws = 0;
    for (; next < kSampledSides && (next + 0.5) / kSampledSides < sum; ++next) ++draws;
    if (draws > 0) samples.push_back({static_cast<std::uint32_t>(k), draws / (kSampledSides * share), draws});
  }
  return samples;
}

bool is_closed(std::span<const SideSample> samples) {
  return std::ranges::all_of(samples, [](const SideSample& sample) { return sample.view.escape == 0; });
}

double closure_defect_rms(const Unknowns& unknowns, std::span<const double> row_sums,
                          std::span<const SideSample> samples) {
  double squares = 0, sum = 0;
  for (const SideSample& sample : samples) {
    const double closed = 1 - static_cast<double>(sample.view.escape) - static_cast<double>(sample.view.dark);
    const double off = row_sums[sample.unknown] - closed,
                 area = sample.weight * unknowns.area[sample.unknown];
    squares += area * off * off;
    sum += area;
  }
  return sum > 0 ? std::sqrt(squares / sum) : 0;
}

std::vector<SideSample> all_sides(const Unknowns& unknowns, std::span<const SideView> views) {
  std::vector<SideSample> samples;
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    if (unknowns.area[k] > 0) samples.push_back({static_cast<std::uint32_t>(k), 1, 1, views[k]});
  return samples;
}

}  // namespace fluxel

#include "formfactor/visibility_probe.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "core/sampling.hpp"

namespace fluxel {

void VisibilityProbe::add(const PairBit& pair) {
  // A point anywhere in each quarter, because blockers often stand in line with the elements; another quarter
  // of j for each of i.
  const std::uint64_t turn = random_bits(std::uint64_t{pair.i} << 32 | pair.j);
  for (std::size_t k = 0; k < kRays; ++k) {
    const std::size_t other = (k ^ turn) % kRays;
    std::uint64_t bits = random_bits(turn + k);
    const auto point = [&](std::size_t element, std::size_t quarter) {
      const double u = static_cast<double>(bits & 0xFFFF) / 0x10000,
                   v = static_cast<double>(bits >> 16 & 0xFFFF) / 0x10000;
      bits >>= 32;
      return surface_point(mesh_.outlines[element], (static_cast<double>(quarter >> 1u) + u) / 2,
                           (static_cast<double>(quarter & 1u) + v) / 2);
    };
    const glm::dvec3 from = point(pair.i, k), to = point(pair.j, other);
    const auto towards = [this](std::size_t element, const glm::dvec3& d) {
      const glm::dvec3 normal(mesh_.elements[element].normal);
      return std::copysign(1.0, glm::dot(normal, d)) * normal;
    };
    segments_[count_ * kRays + k] = {from, towards(pair.i, to - from), to, towards(pair.j, from - to)};
  }
  pairs_[count_] = pair;
  if (++count_ == kPairs) trace();
}

void VisibilityProbe::finish() {
  if (count_ > 0) trace();
}

void VisibilityProbe::trace() {
  const std::uint32_t free = free_segments(ray_scene_, std::span(segments_).first(count_ * kRays));
  for (std::size_t p = 0; p < count_; ++p) {
    constexpr std::uint32_t kAll = (1u << kRays) - 1;
    const std::uint32_t of_pair = free >> (p * kRays) & kAll;
    if (of_pair != (pairs_[p].sees ? kAll : 0u)) contradicted_.push_back(pairs_[p]);
  }
  rays_ += count_ * kRays;
  count_ = 0;
}

}  // namespace fluxel

#include "formfactor/visibility_probe.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

void VisibilityProbe::add(const PairBit& pair) {
  constexpr PointGrid kQuarters{2, 2};
  // Another quarter of j for each of i; which one turns with the pair, so that errors do not line up.
  const std::size_t turn = pair.i + pair.j;
  for (std::size_t k = 0; k < kRays; ++k) {
    const std::size_t other = (k ^ turn) % kRays;
    const auto point = [this, kQuarters](std::size_t element, std::size_t quarter) {
      return grid_point(mesh_.outlines[element], kQuarters, static_cast<int>(quarter / 2),
                        static_cast<int>(quarter % 2));
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
    if (of_pair != (pairs_[p].sees ? kAll : 0u)) doubtful_.push_back(pairs_[p]);
  }
  rays_ += count_ * kRays;
  count_ = 0;
}

}  // namespace fluxel

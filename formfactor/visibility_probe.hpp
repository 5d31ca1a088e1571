#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/element.hpp"
#include "formfactor/free_segments.hpp"

namespace fluxel {

/// A pair of elements i < j, and the bit that the ray between their centroids gave.
struct PairBit {
  std::size_t i = 0, j = 0;
  bool sees = false;
};

/// Asks a few rays of a pair, from each quarter of an element to one of the other, whether its bit says
/// enough. Four pairs share a packet.
class VisibilityProbe {
 public:
  static constexpr std::size_t kRays = 4;  ///< a pair

  /// Both must outlive this.
  VisibilityProbe(const RayScene& ray_scene, const ElementView& mesh) : ray_scene_(ray_scene), mesh_(mesh) {}

  /// Pairs of which a ray says other than the bit come into contradicted(), now or later.
  void add(const PairBit& pair);
  void finish();

  [[nodiscard]] const std::vector<PairBit>& contradicted() const { return contradicted_; }
  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  static constexpr std::size_t kPairs = RayPacket::kSize / kRays;

  void trace();

  const RayScene& ray_scene_;
  ElementView mesh_;
  std::array<SurfaceSegment, RayPacket::kSize> segments_;
  std::array<PairBit, kPairs> pairs_;
  std::size_t count_ = 0;
  std::vector<PairBit> contradicted_;
  std::uint64_t rays_ = 0;
};

}  // namespace fluxel

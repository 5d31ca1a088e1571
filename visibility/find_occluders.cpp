#include "visibility/find_occluders.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/find_occluders.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include <glm/geometric.hpp>

#include "visibility/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

/// A shaft's planes and corners, one coordinate an array.
struct ShaftLanes {
  static constexpr std::size_t kPlanes = 32, kCorners = 16;
  static_assert(Shaft::kMaxPlanes <= kPlanes && 2 * Shaft::kMaxCorners <= kCorners);
  alignas(64) std::array<float, kPlanes> normal_x{}, normal_y{}, normal_z{}, offset;
  alignas(64) std::array<float, kCorners> corner_x, corner_y, corner_z;
  std::size_t planes = 0;
  float margin = 0;

  ShaftLanes(const Shaft& shaft, float extent) : margin(24 * 0x1p-24f * extent) {
    offset.fill(-1);  // with a normal of zero: all is inside
    for (const Shaft::HalfSpace& plane : shaft.planes()) {
      normal_x[planes] = static_cast<float>(plane.normal.x);
      normal_y[planes] = static_cast<float>(plane.normal.y);
      normal_z[planes] = static_cast<float>(plane.normal.z);
      offset[planes] = static_cast<float>(plane.offset) - margin;
      ++planes;
    }
    for (std::size_t k = 0; k < kCorners; ++k) {
      const glm::dvec3& corner = shaft.corners()[std::min(k, shaft.corners().size() - 1)];
      corner_x[k] = static_cast<float>(corner.x);
      corner_y[k] = static_cast<float>(corner.y);
      corner_z[k] = static_cast<float>(corner.z);
    }
  }

  /// False only where the box is beyond one of the planes.
  [[nodiscard]] bool may_meet(const Box& box) const {
    const Float d;
    const Vec3 low = set(d, glm::vec3(box.low)), high = set(d, glm::vec3(box.high));
    for (std::size_t k = 0; k < planes; k += hn::Lanes(d)) {
      const Vec x = hn::Load(d, &normal_x[k]), y = hn::Load(d, &normal_y[k]), z = hn::Load(d, &normal_z[k]);
      const Vec farthest = hn::Add(hn::Max(hn::Mul(x, low.x), hn::Mul(x, high.x)),
                                   hn::Add(hn::Max(hn::Mul(y, low.y), hn::Mul(y, high.y)),
                                           hn::Max(hn::Mul(z, low.z), hn::Mul(z, high.z))));
      if (!hn::AllTrue(d, hn::Gt(farthest, hn::Load(d, &offset[k])))) return false;
    }
    return true;
  }

  /// False only where the occluder is beyond one of the planes, or its own plane leaves the hull on one side.
  [[nodiscard]] bool may_meet(const Occluder& occluder) const {
    const Float d;
    for (std::size_t k = 0; k < planes; k += hn::Lanes(d)) {
      const Vec3 normal{hn::Load(d, &normal_x[k]), hn::Load(d, &normal_y[k]), hn::Load(d, &normal_z[k])};
      Vec farthest = dot(normal, set(d, occluder.corner[0]));
      for (std::size_t corner = 1; corner < 4; ++corner)
        farthest = hn::Max(farthest, dot(normal, set(d, occluder.corner[corner])));
      if (!hn::AllTrue(d, hn::Gt(farthest, hn::Load(d, &offset[k])))) return false;
    }
    const Vec3 normal = set(d, occluder.normal), base = set(d, occluder.corner[0]);
    const Vec above = hn::Set(d, margin), below = hn::Neg(above);
    bool all_above = true, all_below = true;
    for (std::size_t k = 0; k < kCorners; k += hn::Lanes(d)) {
      const Vec3 corner{hn::Load(d, &corner_x[k]), hn::Load(d, &corner_y[k]), hn::Load(d, &corner_z[k])};
      const Vec height = dot(normal, corner - base);
      all_above = all_above && hn::AllTrue(d, hn::Gt(height, above));
      all_below = all_below && hn::AllTrue(d, hn::Lt(height, below));
    }
    return !all_above && !all_below;
  }
};

bool find_occluders(const PatchTree& tree, std::span<const Occluder> occluders, const Shaft& shaft,
                    float extent, std::size_t most, std::vector<PatchId>& ids) {
  const ShaftLanes lanes(shaft, extent);
  ids.clear();
  return !tree.search([&](const Box& box) { return lanes.may_meet(box); },
                      [&](PatchId id) {
                        if (!lanes.may_meet(occluders[index(id)])) return false;
                        ids.push_back(id);
                        return ids.size() > most;
                      });
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(find_occluders);

bool find_occluders(const PatchTree& tree, std::span<const Occluder> occluders, const Shaft& shaft,
                    float extent, std::size_t most, std::vector<PatchId>& ids) {
  return HWY_DYNAMIC_DISPATCH(find_occluders)(tree, occluders, shaft, extent, most, ids);
}

}  // namespace fluxel

#endif  // HWY_ONCE

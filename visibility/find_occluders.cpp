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
  [[nodiscard]] bool may_meet(const glm::vec3& box_low, const glm::vec3& box_high) const {
    const Float d;
    const Vec3 low = set(d, box_low), high = set(d, box_high);
    for (std::size_t k = 0; k < planes; k += hn::Lanes(d)) {
      const Vec x = hn::Load(d, &normal_x[k]), y = hn::Load(d, &normal_y[k]), z = hn::Load(d, &normal_z[k]);
      const Vec farthest = hn::Add(hn::Max(hn::Mul(x, low.x), hn::Mul(x, high.x)),
                                   hn::Add(hn::Max(hn::Mul(y, low.y), hn::Mul(y, high.y)),
                                           hn::Max(hn::Mul(z, low.z), hn::Mul(z, high.z))));
      if (!hn::AllTrue(d, hn::Gt(farthest, hn::Load(d, &offset[k])))) return false;
    }
    return true;
  }

  /// False only where all corners are beyond one of the planes.
  [[nodiscard]] bool may_meet(std::span<const glm::vec3> corners) const {
    const Float d;
    for (std::size_t k = 0; k < planes; k += hn::Lanes(d)) {
      const Vec3 normal{hn::Load(d, &normal_x[k]), hn::Load(d, &normal_y[k]), hn::Load(d, &normal_z[k])};
      Vec farthest = dot(normal, set(d, corners[0]));
      for (const glm::vec3& corner : corners.subspan(1))
        farthest = hn::Max(farthest, dot(normal, set(d, corner)));
      if (!hn::AllTrue(d, hn::Gt(farthest, hn::Load(d, &offset[k])))) return false;
    }
    return true;
  }

  struct PlaneSide {
    bool above = true, below = true;  // of the whole hull
  };

  [[nodiscard]] PlaneSide side_of_plane(const glm::vec3& face_normal, const glm::vec3& face_corner) const {
    const Float d;
    const Vec3 normal = set(d, face_normal), base = set(d, face_corner);
    const Vec least = hn::Set(d, margin), most = hn::Neg(least);
    PlaneSide side;
    for (std::size_t k = 0; k < kCorners; k += hn::Lanes(d)) {
      const Vec3 corner{hn::Load(d, &corner_x[k]), hn::Load(d, &corner_y[k]), hn::Load(d, &corner_z[k])};
      const Vec height = dot(normal, corner - base);
      side.above = side.above && hn::AllTrue(d, hn::Gt(height, least));
      side.below = side.below && hn::AllTrue(d, hn::Lt(height, most));
    }
    return side;
  }

  /// False only where the occluder is beyond one of the planes, or its own plane leaves the hull on one side.
  [[nodiscard]] bool may_meet(const Occluder& occluder) const {
    if (!may_meet(occluder.corner)) return false;
    const PlaneSide side = side_of_plane(occluder.normal, occluder.corner[0]);
    return !side.above && !side.below;
  }

  /// False only where the body is beyond one of the planes, or the hull is before one of its faces or behind
  /// all of them.
  [[nodiscard]] bool may_meet(const ConvexBody& body) const {
    if (!may_meet(std::span(body.corner).first(body.corners))) return false;
    bool behind_all = true;
    for (std::uint32_t k = 0; k < body.planes; ++k) {
      const PlaneSide side = side_of_plane(body.normal[k], body.base[k]);
      if (side.above) return false;
      behind_all = behind_all && side.below;
    }
    return !behind_all;
  }
};

bool find_occluders(const PatchTree& tree, std::span<const Occluder> occluders, const Shaft& shaft,
                    float extent, std::size_t most, std::vector<PatchId>& ids) {
  const ShaftLanes lanes(shaft, extent);
  ids.clear();
  return !tree.search([&](const Box& box) { return lanes.may_meet(glm::vec3(box.low), glm::vec3(box.high)); },
                      [&](PatchId id) {
                        if (!lanes.may_meet(occluders[index(id)])) return false;
                        ids.push_back(id);
                        return ids.size() > most;
                      });
}

bool find_bodies(const BodyTree& tree, const Shaft& shaft, float extent, std::size_t most,
                 std::vector<std::uint32_t>& numbers) {
  const ShaftLanes lanes(shaft, extent);
  numbers.clear();
  return !tree.search([&](const glm::vec3& low, const glm::vec3& high) { return lanes.may_meet(low, high); },
                      [&](std::uint32_t number) {
                        if (!lanes.may_meet(tree.bodies()[number])) return false;
                        numbers.push_back(number);
                        return numbers.size() > most;
                      });
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(find_occluders);
HWY_EXPORT(find_bodies);

bool find_occluders(const PatchTree& tree, std::span<const Occluder> occluders, const Shaft& shaft,
                    float extent, std::size_t most, std::vector<PatchId>& ids) {
  return HWY_DYNAMIC_DISPATCH(find_occluders)(tree, occluders, shaft, extent, most, ids);
}

bool find_occluders(const BodyTree& tree, const Shaft& shaft, float extent, std::size_t most,
                    std::vector<std::uint32_t>& numbers) {
  return HWY_DYNAMIC_DISPATCH(find_bodies)(tree, shaft, extent, most, numbers);
}

}  // namespace fluxel

#endif  // HWY_ONCE

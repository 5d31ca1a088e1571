// Vectors of three coordinates, many at a time, for the instruction set that is being compiled: to be
// included after hwy/highway.h, inside no namespace, once for each of Highway's targets.
#if defined(FLUXEL_VISIBILITY_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef FLUXEL_VISIBILITY_LANES_INL_HPP
#undef FLUXEL_VISIBILITY_LANES_INL_HPP
#else
#define FLUXEL_VISIBILITY_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <type_traits>

#include "visibility/tile_points.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::CappedTag<float, TileVectors::kMaxLanes>;
using Vec = hn::Vec<Float>;
using Mask = hn::Mask<Float>;

struct Vec3 {
  Vec x, y, z;
};

HWY_INLINE Vec3 set(Float d, const glm::vec3& v) {
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

/// Of arrays x, y and z.
template <class Vectors>
HWY_INLINE Vec3 load(Float d, const Vectors& v, std::size_t first) {
  return {hn::LoadU(d, v.x.data() + first), hn::LoadU(d, v.y.data() + first),
          hn::LoadU(d, v.z.data() + first)};
}

template <class Vectors>
HWY_INLINE void store(Float d, const Vec3& v, Vectors& to, std::size_t first) {
  hn::StoreU(v.x, d, to.x.data() + first);
  hn::StoreU(v.y, d, to.y.data() + first);
  hn::StoreU(v.z, d, to.z.data() + first);
}

HWY_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vec dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

/// Bit k is lane k.
HWY_INLINE std::uint64_t bits_of(Float d, Mask mask) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, mask, bytes.data());
  // As much as has been stored: to read more the processor would wait until it has left the store buffer.
  std::conditional_t<(hn::MaxLanes(Float()) > 8), std::uint16_t, std::uint8_t> word;
  std::memcpy(&word, bytes.data(), sizeof word);
  return word;
}

HWY_INLINE Mask mask_of(Float d, std::uint64_t word) {
  return hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&word));
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

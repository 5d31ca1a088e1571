#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstdint>
#include <span>
#include <vector>

#include "bench/visibility/engine.hpp"
#include "core/element.hpp"
#include "scene/scene.hpp"

namespace fluxel::bench {

/// Rays in Embree's own packets of 16, the last one of a tile excepted.
struct TilePackets {
  std::vector<RTCRay16> packets;
  std::uint64_t rays = 0;
};

/// The plain way: a ray for every pair of the tile that has unknown sides facing each other, from the lower
/// to the higher element, both ends lifted off their elements' planes by `lift` [m]; square blocks of pairs
/// of this side after each other, or row by row where it is 1. What is in `out` is replaced.
void pack_tile(float lift, std::span<const Element> elements, const TilePlace& place, std::size_t block,
               TilePackets& out);

/// Embree and nothing around it: the patches' triangles, and rtcOccluded16.
class RawEmbree {
 public:
  /// Without ROBUST Embree is faster, but rays slip through the edges between triangles.
  RawEmbree(const Scene& scene, bool robust);
  ~RawEmbree();
  RawEmbree(const RawEmbree&) = delete;
  RawEmbree& operator=(const RawEmbree&) = delete;

  /// Traces packets that have not been traced yet, full ones as coherent where that is wanted; returns how
  /// many rays meet nothing.
  std::uint64_t trace(TilePackets& tile, bool coherent) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace fluxel::bench

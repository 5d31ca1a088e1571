#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/hash.hpp"
#include "hierarchy/link.hpp"

namespace fluxel::test_scenes {

/// Of links in any order: a sum of what each says.
inline std::uint64_t hash_of(std::span<const Link> links) {
  std::uint64_t sum = 0;
  for (const Link& b : links) {
    const std::array<float, 2> values{b.G, b.G_error};
    const std::array<NodeId, 3> whole{b.p, b.q, b.partial ? 1u : 0u};
    const std::array<std::int8_t, 4> slopes{b.over_p.u, b.over_p.v, b.over_q.u, b.over_q.v};
    std::uint64_t hash = hash_bytes(std::as_bytes(std::span(values)));
    hash = hash_bytes(std::as_bytes(std::span(whole)), hash);
    sum += hash_bytes(std::as_bytes(std::span(slopes)), hash);
  }
  return sum;
}

}  // namespace fluxel::test_scenes

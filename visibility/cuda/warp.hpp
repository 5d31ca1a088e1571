#pragma once

#include "visibility/cuda/portable.hpp"

namespace fluxel::cuda {

inline constexpr std::uint32_t kLanes = 32;

/// Number of bits that are set.
FLUXEL_PORTABLE inline std::uint32_t count_bits(std::uint32_t word) {
#ifdef __CUDA_ARCH__
  return static_cast<std::uint32_t>(__popc(static_cast<int>(word)));
#else
  return static_cast<std::uint32_t>(__builtin_popcount(word));
#endif
}

/// The place of the lowest bit of a word that has one.
FLUXEL_PORTABLE inline std::uint32_t lowest_bit(std::uint32_t word) {
#ifdef __CUDA_ARCH__
  return static_cast<std::uint32_t>(__ffs(static_cast<int>(word)) - 1);
#else
  return static_cast<std::uint32_t>(__builtin_ctz(word));
#endif
}

/// Thirty-two lanes that go the same way: on a device a warp, where every lane runs the code beside the
/// others; on the host a loop, so that the same code is tested there. Code for a warp keeps what lanes share
/// in memory given to it, and works in steps: what one has written, the next can read.
class Warp {
 public:
  /// f(lane) for all lanes.
  template <class Function>
  FLUXEL_PORTABLE void each(Function f) const {
#ifdef __CUDA_ARCH__
    f(threadIdx.x % kLanes);
    __syncwarp();
#else
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) f(lane);
#endif
  }

  /// A word whose bit k is f(k), for all lanes to read.
  template <class Function>
  FLUXEL_PORTABLE std::uint32_t ballot(Function f) const {
#ifdef __CUDA_ARCH__
    return __ballot_sync(0xFFFFFFFFu, f(threadIdx.x % kLanes));
#else
    std::uint32_t word = 0;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) word |= static_cast<std::uint32_t>(f(lane)) << lane;
    return word;
#endif
  }
};

/// What each lane keeps for itself from one step to the next: registers on a device, an array on the host.
template <class Item>
class PerLane {
 public:
  FLUXEL_PORTABLE Item& operator[]([[maybe_unused]] std::uint32_t lane) {
#ifdef __CUDA_ARCH__
    return item_;
#else
    return items_[lane];
#endif
  }

 private:
#ifdef __CUDA_ARCH__
  Item item_{};
#else
  Item items_[kLanes]{};
#endif
};

}  // namespace fluxel::cuda

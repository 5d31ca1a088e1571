#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/gpu_check/scenes.hpp"
#include "visibility/cuda/device_tracer.hpp"

namespace fluxel::cuda::checks {

/// What came of a comparison; all has to be as it should where `differing` is 0.
struct Comparison {
  std::string scene, against;
  std::size_t elements = 0;
  std::uint64_t pairs = 0, visible = 0;  ///< compared
  std::uint64_t facing = 0;              ///< pairs of sides that face each other in the tiles looked at
  std::uint64_t differing = 0;
};

struct CheckedScene {
  const CheckScene& scene;
  const SceneArrays& arrays;
  std::size_t elements;
};

/// The kernel's code on the host against brute force, on rows of tiles from all parts of the matrix, so many
/// that about `segment_tests` are made. Differences are printed with how near they are to being none.
[[nodiscard]] Comparison compare_with_brute_force(const CheckedScene& checked, double segment_tests,
                                                  unsigned threads);

/// The same code against what is known of a scene where nothing sees anything.
[[nodiscard]] Comparison compare_with_nothing_seen(const CheckedScene& checked, std::size_t tiles,
                                                   unsigned threads);

/// The device's tiles against the host's, bit for bit, from all parts of the matrix.
[[nodiscard]] Comparison compare_with_device(const CheckedScene& checked, DeviceTracer& tracer,
                                             std::size_t tiles, unsigned threads);

}  // namespace fluxel::cuda::checks

#pragma once

#include <string>
#include <vector>

#include "bench/gpu_check/correctness.hpp"
#include "bench/gpu_check/device_limits.hpp"
#include "bench/gpu_check/hits.hpp"
#include "bench/gpu_check/octrees.hpp"
#include "bench/gpu_check/paths.hpp"
#include "bench/gpu_check/rows.hpp"
#include "bench/gpu_check/speed.hpp"
#include "bench/gpu_check/work_count.hpp"

namespace fluxel::cuda::checks {

/// Speed in a scene with so many elements; `device` is all 0 without one, and so is `by_launch`, where no two
/// launches overlap.
struct Figures {
  std::string scene;
  std::size_t patches = 0, elements = 0;
  Speed device, by_launch, host;
  WorkOfPair work;
};

/// With so many tiles in a call to the device, of which there are no two at once.
struct LaunchFigures {
  std::size_t tiles = 0;
  Speed device;
};

struct DeviceFigures {
  bool measured = false;
  std::string why_not;  ///< a sentence
  DeviceProperties properties;
  DeviceLimits limits;
  std::string launch_scene;  ///< and its elements, of `launches`
  std::vector<LaunchFigures> launches;
};

struct Results {
  std::vector<Comparison> comparisons;
  std::vector<Figures> figures;
  std::vector<HitFigures> hits;
  std::vector<PathFigures> paths;
  std::vector<OctreeFigures> octrees;
  std::vector<RowFigures> rows;  // of a device alone
  DeviceFigures device;
};

void print_comparison(const Comparison& comparison);
void print_figures(const Results& results);

[[nodiscard]] std::string to_json(const Results& results);

}  // namespace fluxel::cuda::checks

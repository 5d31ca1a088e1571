#include "bench/gpu_check/speed.hpp"

#include <algorithm>
#include <vector>

#include "bench/gpu_check/stopwatch.hpp"
#include "bench/gpu_check/tiles.hpp"
#include "visibility/cuda/host_trace.hpp"

namespace fluxel::cuda::checks {

namespace {

void set_rate(std::size_t elements, Speed& speed) {
  const double pairs = static_cast<double>(elements) * static_cast<double>(elements);
  speed.pairs_per_second =
      pairs * static_cast<double>(speed.traced) / static_cast<double>(speed.tiles) / speed.seconds;
}

}  // namespace

Speed speed_of_device(const SceneArrays& arrays, std::size_t elements, DeviceTracer& tracer, double seconds,
                      std::size_t tiles_of_strip) {
  const std::vector<TilePlace> places = upper_triangle(arrays.view().tiles);
  const auto strip = [&](std::size_t number) {
    const std::size_t first = number * tiles_of_strip, end = std::min(first + tiles_of_strip, places.size());
    return std::vector<TilePlace>(places.data() + first, places.data() + end);
  };
  tracer.trace(strip(0), [](std::size_t, const TileResult*, std::size_t) {});  // a device that idled is slow
  Speed speed;
  speed.tiles = places.size();
  const DeviceSeconds before = tracer.seconds();
  const Stopwatch stopwatch;
  for (const std::size_t number : spread_order((places.size() + tiles_of_strip - 1) / tiles_of_strip)) {
    tracer.trace(strip(number), [&](std::size_t, const TileResult* results, std::size_t count) {
      for (std::size_t k = 0; k < count; ++k) speed.facing += results[k].facing;
      speed.traced += count;
    });
    if (stopwatch.seconds() > seconds) break;
  }
  speed.seconds = stopwatch.seconds();
  speed.device = {tracer.seconds().kernel - before.kernel, tracer.seconds().transfer - before.transfer};
  set_rate(elements, speed);
  return speed;
}

Speed speed_of_host(const SceneArrays& arrays, std::size_t elements, double seconds) {
  const TileScene scene = arrays.view();
  const std::vector<TilePlace> places = upper_triangle(scene.tiles);
  Speed speed;
  speed.tiles = places.size();
  const std::vector<std::size_t> order = spread_order(places.size());
  const Stopwatch stopwatch;
  for (const std::size_t number : order) {
    speed.facing += trace_on_host(scene, places[number]).facing;
    ++speed.traced;
    if (stopwatch.seconds() > seconds) break;
  }
  speed.seconds = stopwatch.seconds();
  set_rate(elements, speed);
  return speed;
}

}  // namespace fluxel::cuda::checks

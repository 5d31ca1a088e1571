#include "bench/gpu_check/tiles.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <thread>

namespace fluxel::cuda::checks {

std::vector<TilePlace> upper_triangle(std::uint32_t tiles) {
  std::vector<TilePlace> places;
  places.reserve(std::size_t{tiles} * (tiles + 1) / 2);
  for (std::uint32_t row = 0; row < tiles; ++row)
    for (std::uint32_t column = row; column < tiles; ++column) places.push_back({row, column});
  return places;
}

std::vector<std::size_t> spread_order(std::size_t count) {
  // Multiples of the golden section lie evenly, however many there are (Weyl's sequence).
  auto step = static_cast<std::size_t>(std::llround(0.6180339887498949 * static_cast<double>(count)));
  step = std::max<std::size_t>(step, 1);
  while (std::gcd(step, count) > 1) ++step;
  std::vector<std::size_t> order(count);
  for (std::size_t k = 1; k < count; ++k) order[k] = (order[k - 1] + step) % count;
  return order;
}

std::vector<TilePlace> spread_tiles(std::uint32_t tiles, std::size_t wanted) {
  const std::vector<TilePlace> all = upper_triangle(tiles);
  std::vector<std::size_t> order = spread_order(all.size());
  order.resize(std::min(order.size(), wanted));
  std::vector<TilePlace> places;
  places.reserve(order.size());
  for (const std::size_t number : order) places.push_back(all[number]);
  return places;
}

void in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& f) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) f(k);
  };
  std::vector<std::thread> others;
  for (unsigned thread = 1; thread < threads; ++thread) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
}

}  // namespace fluxel::cuda::checks

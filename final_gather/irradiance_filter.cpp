#include "final_gather/irradiance_filter.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace fluxel {

namespace {

/// Pixels to each side of the one that is filtered; the window of (2 r + 1)^2 has to have a bit each.
constexpr int kReach = 3;

/// Likewise of the surroundings that are compared.
constexpr int kSurroundings = 1;

/// Of normals of one surface.
constexpr double kLeastCosine = 0.99;

/// In distances between pixels: what a surface may bend within one.
constexpr double kOffPlane = 2;

/// How far surroundings may differ, in squares of their noise. By comparing pictures of stairs and a hall.
constexpr double kNoiseSquared = 0.5;

constexpr std::size_t kGrain = 256;

/// Calls `visit(dx, dy, bit)` for each pixel of the window.
template <class Visit>
void visit_window(const Visit& visit) {
  std::uint32_t bit = 0;
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx) visit(dx, dy, bit++);
}

template <class Work>
void for_each_pixel(std::size_t from, std::size_t to, int threads, const Work& work) {
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(from, to, kGrain), [&](const auto& range) {
      for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) work(pixel);
    });
  });
}

std::vector<double> sizes_of(std::span<const Rgb> light) {
  std::vector<double> sizes;
  sizes.reserve(light.size());
  for (const Rgb& H : light) sizes.push_back(mean_of_colours(H));
  return sizes;
}

}  // namespace

/// A pixel and what lies around it.
class IrradianceFilter::Window {
 public:
  Window(const IrradianceFilter& of, std::size_t pixel)
      : of_(of),
        pixel_(pixel),
        x_(static_cast<int>(pixel) % of.width_),
        y_(static_cast<int>(pixel) / of.width_) {}

  [[nodiscard]] bool holds(int dx, int dy) const {
    return x_ + dx >= 0 && x_ + dx < of_.width_ && y_ + dy >= 0 && y_ + dy < of_.height_;
  }
  [[nodiscard]] std::size_t at(int dx, int dy) const {
    return static_cast<std::size_t>(y_ + dy) * static_cast<std::size_t>(of_.width_) +
           static_cast<std::size_t>(x_ + dx);
  }
  [[nodiscard]] bool sees(int dx, int dy) const {
    return holds(dx, dy) && of_.seen_[at(dx, dy)].material != SeenSurface::kNothing;
  }

  /// [m] to the nearest of the four neighbours.
  [[nodiscard]] double spacing() const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [dx, dy] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      if (sees(dx, dy))
        least = std::min(least, glm::distance(of_.seen_[at(dx, dy)].position, of_.seen_[pixel_].position));
    return least;
  }

  /// What lies on one surface with it.
  [[nodiscard]] std::uint64_t alike() const {
    const SeenSurface& here = of_.seen_[pixel_];
    if (here.material == SeenSurface::kNothing) return 0;
    const double step = kOffPlane * spacing();
    std::uint64_t bits = 0;
    visit_window([&](int dx, int dy, std::uint32_t bit) {
      if (!holds(dx, dy)) return;
      const bool is_here = dx == 0 && dy == 0;  // whose spacing may be infinite
      const SeenSurface& there = of_.seen_[at(dx, dy)];
      if (is_here ||
          (there.material == here.material && glm::dot(there.normal, here.normal) >= kLeastCosine &&
           std::abs(glm::dot(there.position - here.position, here.normal)) <=
               step * std::max(std::abs(dx), std::abs(dy))))
        bits |= std::uint64_t{1} << bit;
    });
    return bits;
  }

  /// How far the surroundings of two pixels differ beyond their noise, over that.
  [[nodiscard]] static double difference(const Window& a, const Window& b, std::span<const double> size,
                                         std::span<const double> noise) {
    double sum = 0;
    int count = 0;
    for (int dy = -kSurroundings; dy <= kSurroundings; ++dy)
      for (int dx = -kSurroundings; dx <= kSurroundings; ++dx) {
        if (!a.sees(dx, dy) || !b.sees(dx, dy)) continue;
        const std::size_t p = a.at(dx, dy), q = b.at(dx, dy);
        const double d = size[p] - size[q], both = noise[p] + noise[q];
        const double least = std::numeric_limits<double>::min();
        sum += (d * d - noise[p] - std::min(noise[p], noise[q])) / (kNoiseSquared * both + least);
        ++count;
      }
    return std::max(0.0, sum / count);
  }

 private:
  const IrradianceFilter& of_;
  std::size_t pixel_;
  int x_, y_;
};

IrradianceFilter::IrradianceFilter(int width, std::vector<SeenSurface> seen)
    : width_(width),
      height_(static_cast<int>(seen.size()) / width),
      seen_(std::move(seen)),
      alike_(seen_.size()) {
  static_assert((2 * kReach + 1) * (2 * kReach + 1) <= 64);
  for (std::size_t pixel = 0; pixel < seen_.size(); ++pixel) alike_[pixel] = Window(*this, pixel).alike();
}

/// Variance of one half, by how the halves differ around each pixel.
std::vector<double> IrradianceFilter::noise_of(const std::array<std::vector<double>, 2>& sizes,
                                               int threads) const {
  std::vector<double> noise(seen_.size());
  for_each_pixel(0, seen_.size(), threads, [&](std::size_t pixel) {
    const Window window(*this, pixel);
    double sum = 0;
    int count = 0;
    visit_window([&](int dx, int dy, std::uint32_t bit) {
      if ((alike_[pixel] >> bit & 1u) == 0) return;
      const double d = sizes[0][window.at(dx, dy)] - sizes[1][window.at(dx, dy)];
      sum += d * d / 2;
      ++count;
    });
    if (count > 0) noise[pixel] = sum / count;
  });
  return noise;
}

IrradianceHalves IrradianceFilter::filter(const IrradianceHalves& halves, std::size_t from, std::size_t to,
                                          int threads) const {
  const std::array sizes{sizes_of(halves[0]), sizes_of(halves[1])};
  const std::vector<double> noise = noise_of(sizes, threads);
  IrradianceHalves filtered{std::vector<Rgb>(to - from), std::vector<Rgb>(to - from)};
  for_each_pixel(from, to, threads, [&](std::size_t pixel) {
    const Window here(*this, pixel);
    std::array<Rgb, 2> sums{};
    std::array<double, 2> weights{};
    visit_window([&](int dx, int dy, std::uint32_t bit) {
      if ((alike_[pixel] >> bit & 1u) == 0) return;
      const std::size_t other = here.at(dx, dy);
      const Window there(*this, other);
      for (std::size_t half = 0; half < 2; ++half) {
        const double weight = std::exp(-Window::difference(here, there, sizes[1 - half], noise));
        sums[half] += weight * halves[half][other];
        weights[half] += weight;
      }
    });
    // Where nothing is seen there are none.
    for (std::size_t half = 0; half < 2; ++half)
      if (weights[half] > 0) filtered[half][pixel - from] = sums[half] / weights[half];
  });
  return filtered;
}

}  // namespace fluxel

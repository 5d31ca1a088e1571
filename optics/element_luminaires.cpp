#include "optics/element_luminaires.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "optics/luminaire_light.hpp"

namespace fluxel {

namespace {

/// Of an element: the first points, which tell how many others its mean is then made of, and the most.
constexpr std::size_t kPilots = 8, kMostPoints = 1024;

/// Standard error of a mean that so many random points would have, relative to it; even ones have less.
constexpr double kError = 0.02;

/// Rays from each: where there are more luminaires they are drawn from.
constexpr std::size_t kDraws = 16;

Rgb mean_over(const LuminaireLight& luminaires, const Outline<glm::vec3>& outline, const glm::dvec3& normal,
              std::uint64_t seed) {
  std::uint64_t traced = 0;
  const auto sample = [&](std::uint64_t numbers, std::size_t count, const auto& take) {
    SobolPoints points(random_bits(numbers));
    for (std::size_t k = 0; k < count; ++k) {
      const auto [u, v, unused, other] = points.next();
      take(luminaires.sampled_irradiance({surface_point(outline, u, v), normal}, kDraws,
                                         random_bits(~(numbers << 12 | k)), traced));
    }
  };
  double pilots = 0, squares = 0;
  sample(2 * seed, kPilots, [&](const Rgb& H) {
    pilots += mean_of_colours(H) / kPilots;
    squares += mean_of_colours(H) * mean_of_colours(H) / kPilots;
  });
  const double variance = std::max(0.0, squares - pilots * pilots);
  const double wanted = pilots > 0 ? variance / (kError * kError * pilots * pilots) : 0;
  const std::size_t count = std::bit_ceil(static_cast<std::size_t>(
      std::clamp(wanted, static_cast<double>(kPilots), static_cast<double>(kMostPoints))));
  Rgb sum(0);
  sample(2 * seed + 1, count, [&](const Rgb& H) { sum += H; });
  return sum / static_cast<double>(count);
}

}  // namespace

std::vector<Rgb> first_light_of_elements(const RayScene& ray_scene, const ElementView& mesh,
                                         std::size_t first, std::size_t count, bool two_sided, int threads) {
  const LuminaireLight luminaires(ray_scene);
  if (luminaires.empty()) return {};
  std::vector<Rgb> H0((two_sided ? 2 : 1) * count, Rgb(0));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const std::size_t number = first + k;
        const Element& element = mesh.elements[number];
        const glm::dvec3 normal = glm::normalize(glm::dvec3(element.normal));
        if ((element.sides & kFront) != 0)
          H0[k] = mean_over(luminaires, mesh.outlines[number], normal, 2 * number);
        if ((element.sides & kBack) != 0)
          H0[count + k] = mean_over(luminaires, mesh.outlines[number], -normal, 2 * number + 1);
      }
    });
  });
  return H0;
}

}  // namespace fluxel

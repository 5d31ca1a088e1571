#include "optics/element_luminaires.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <glm/geometric.hpp>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "optics/luminaire_light.hpp"

namespace fluxel {

namespace {

/// Of an element, and rays from each: where there are more luminaires they are drawn from.
constexpr std::size_t kPoints = 8, kDraws = 16;

Rgb mean_over(const LuminaireLight& luminaires, const Outline<glm::vec3>& outline, const glm::dvec3& normal,
              std::uint64_t seed) {
  SobolPoints points(random_bits(seed));
  Rgb sum(0);
  std::uint64_t traced = 0;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const auto [u, v, unused, other] = points.next();
    sum += luminaires.sampled_irradiance({surface_point(outline, u, v), normal}, kDraws,
                                         random_bits(~(seed * kPoints + k)), traced);
  }
  return sum / static_cast<double>(kPoints);
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

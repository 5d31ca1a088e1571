#include "core/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {

std::uint64_t random_bits(std::uint64_t seed) {
  seed += 0x9E3779B97F4A7C15ull;
  seed = (seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9ull;
  seed = (seed ^ (seed >> 27)) * 0x94D049BB133111EBull;
  return seed ^ (seed >> 31);
}

glm::dvec3 cosine_direction(double u, double v, const glm::dvec3& normal) {
  const double a = 2 * u - 1;
  const double b = 2 * v - 1;
  double radius = a, angle = 0;
  if (std::abs(a) > std::abs(b)) {
    angle = std::numbers::pi / 4 * (b / a);
  } else if (b != 0) {
    radius = b;
    angle = std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b);
  }
  const glm::dvec3 least = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(normal, least));
  const glm::dvec3 bitangent = glm::cross(normal, tangent);
  const double height = std::sqrt(std::max(0.0, 1 - radius * radius));
  return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent + height * normal;
}

}  // namespace fluxel

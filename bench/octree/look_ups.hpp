#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "octree/sphere_octree.hpp"

namespace fluxel::bench {

/// Whether a sphere holds a point.
[[nodiscard]] inline bool holds(const Sphere& sphere, const glm::dvec3& point) {
  const double x = point.x - static_cast<double>(sphere.x), y = point.y - static_cast<double>(sphere.y),
               z = point.z - static_cast<double>(sphere.z);
  return x * x + y * y + z * z <= static_cast<double>(sphere.radius) * static_cast<double>(sphere.radius);
}

/// What spheres hold a point tells, in any order of them: their number and the sum of their numbers.
struct Held {
  std::uint64_t count = 0, sum = 0;

  void add(std::uint32_t sphere) {
    ++count;
    sum += sphere;
  }
  bool operator==(const Held&) const = default;
};

/// One way to find the spheres that hold a point.
class LookUp {
 public:
  virtual ~LookUp() = default;
  [[nodiscard]] virtual Held at(const glm::dvec3& point) const = 0;
};

// Spheres must outlive what is made of them; those of `radius` alone are what the grid and nanoflann know.
[[nodiscard]] std::unique_ptr<LookUp> by_octree(std::span<const Sphere> spheres, int threads);
[[nodiscard]] std::unique_ptr<LookUp> by_nanoflann(std::span<const Sphere> spheres, double radius);
/// Cubes of the spheres' diameter in a hash table, each with the spheres whose centre lies there.
[[nodiscard]] std::unique_ptr<LookUp> by_grid(std::span<const Sphere> spheres, double radius);
/// All of them, one by one.
[[nodiscard]] Held by_brute_force(std::span<const Sphere> spheres, const glm::dvec3& point);

}  // namespace fluxel::bench

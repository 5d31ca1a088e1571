#include "octree/sphere_octree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace fluxel {
namespace {

bool holds(const Sphere& sphere, const glm::dvec3& x) {
  const glm::dvec3 d = x - glm::dvec3(sphere.x, sphere.y, sphere.z);
  return glm::dot(d, d) <= static_cast<double>(sphere.radius) * sphere.radius;
}

/// Of many sizes, most of them in a corner.
std::vector<Sphere> random_spheres(std::size_t count, float radius, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Sphere> spheres;
  for (std::size_t k = 0; k < count; ++k) {
    const float crowd = k % 3 == 0 ? 1.0F : 0.1F;
    spheres.push_back({crowd * unit(random), crowd * unit(random), crowd * unit(random),
                       radius * std::pow(unit(random), 4.0F)});
  }
  return spheres;
}

std::vector<std::uint32_t> found_at(const SphereOctree& tree, std::span<const Sphere> spheres,
                                    const glm::dvec3& x) {
  std::vector<std::uint32_t> found;
  tree.for_each_at(x, [&](std::uint32_t k) {
    if (holds(spheres[k], x)) found.push_back(k);
  });
  return found;
}

std::vector<std::uint32_t> all_at(std::span<const Sphere> spheres, const glm::dvec3& x) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t k = 0; k < spheres.size(); ++k)
    if (holds(spheres[k], x)) found.push_back(k);
  return found;
}

TEST(SphereOctree, FindsWhatHoldsAPoint) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.1, 1.1);
  std::size_t found = 0;
  for (const float radius : {0.0F, 0.03F, 0.3F, 30.0F}) {
    const std::vector<Sphere> spheres = random_spheres(3000, radius, 1);
    const SphereOctree tree(spheres, 2);
    for (int k = 0; k < 2000; ++k) {
      const double scale = k % 2 == 0 ? 1 : 0.1;
      const glm::dvec3 x = scale * glm::dvec3(place(random), place(random), place(random));
      const std::vector<std::uint32_t> expected = all_at(spheres, x);
      ASSERT_EQ(found_at(tree, spheres, x), expected) << radius;
      found += expected.size();
    }
    // Centres and the farthest points along axes lie inside, whatever is rounded.
    for (std::uint32_t k = 0; k < spheres.size(); k += 7) {
      const Sphere& s = spheres[k];
      for (const double side : {0.0, -1.0, 1.0})
        for (int axis = 0; axis < 3; ++axis) {
          glm::dvec3 x(s.x, s.y, s.z);
          x[axis] += side * static_cast<double>(s.radius);
          ASSERT_EQ(found_at(tree, spheres, x), all_at(spheres, x)) << k;
        }
    }
  }
  EXPECT_GT(found, 10000U);
}

TEST(SphereOctree, IsTheSameForAnyNumberOfThreads) {
  const std::vector<Sphere> spheres = random_spheres(20000, 0.05F, 2);
  const SphereOctree one(spheres, 1);
  EXPECT_GT(one.nodes().size(), 1000U);
  for (const int threads : {2, 3}) {
    const SphereOctree other(spheres, threads);
    EXPECT_TRUE(std::ranges::equal(one.references(), other.references()));
    EXPECT_TRUE(std::ranges::equal(one.nodes(), other.nodes(), [](const OctreeNode& a, const OctreeNode& b) {
      return a.first == b.first && a.count == b.count;
    }));
  }
}

TEST(SphereOctree, IsBoundedWhateverIsPutIn) {
  // At one place: apart by no level.
  const std::vector<Sphere> alike(50000, Sphere{0.3F, 0.3F, 0.3F, 0});
  std::vector<Sphere> crowd = alike;
  crowd.push_back({1, 1, 1, 0});
  const SphereOctree tree(crowd, 2);
  EXPECT_LE(tree.references().size(), 3 * crowd.size());
  EXPECT_EQ(found_at(tree, crowd, {0.3F, 0.3F, 0.3F}).size(), alike.size());
  // All over each other: children would have eight times as many.
  const SphereOctree whole(std::vector<Sphere>(1000, Sphere{0, 0, 0, 1}), 1);
  EXPECT_EQ(whole.nodes().size(), 1U);
  EXPECT_EQ(whole.references().size(), 1000U);
}

TEST(SphereOctree, MayBeEmpty) {
  const SphereOctree none({}, 1);
  none.for_each_at({0.5, 0.5, 0.5}, [](std::uint32_t) { FAIL(); });
  const std::vector<Sphere> point{{2, 2, 2, 0}};
  const SphereOctree one(point, 1);
  EXPECT_EQ(found_at(one, point, {2, 2, 2}).size(), 1U);
  EXPECT_TRUE(found_at(one, point, {2, 2, 2.001}).empty());
  one.for_each_at({std::nan(""), 0, 0}, [](std::uint32_t) { FAIL(); });
}

TEST(SphereOctree, RefusesWhatIsNoSphere) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  for (const Sphere& wrong : {Sphere{nan, 0, 0, 1}, {0, inf, 0, 1}, {0, 0, 0, nan}, {0, 0, 0, -1}})
    EXPECT_THROW(SphereOctree(std::vector{Sphere{0, 0, 0, 1}, wrong}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace fluxel

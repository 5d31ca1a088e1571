#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "octree/cuda/device_octree.hpp"
#include "octree/cuda/host_octree.hpp"
#include "octree/sphere_octree.hpp"

namespace fluxel {
namespace {

/// Of many sizes, most of them in a corner.
std::vector<Sphere> crowd(std::size_t count, float radius, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Sphere> spheres;
  for (std::size_t k = 0; k < count; ++k) {
    const float reach = k % 3 == 0 ? 1.0F : 0.1F;
    const float x = reach * unit(random), y = reach * unit(random), z = reach * unit(random);
    spheres.push_back({x, y, z, radius * std::pow(unit(random), 4.0F)});
  }
  return spheres;
}

std::vector<std::vector<Sphere>> kinds_of_spheres() {
  std::vector<Sphere> alike(5000, Sphere{0.3F, 0.3F, 0.3F, 0});
  alike.push_back({1, 1, 1, 0});
  return {{},
          {{2, 2, 2, 0}},
          crowd(9, 0.1F, 1),
          crowd(20000, 0.05F, 2),
          crowd(3000, 0, 3),
          crowd(3000, 30, 4),
          alike,
          std::vector<Sphere>(1000, Sphere{0, 0, 0, 1})};
}

template <class T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

TEST(OctreeDevice, ThePassesOfADeviceMakeTheSameTree) {
  std::size_t nodes = 0;
  for (const std::vector<Sphere>& spheres : kinds_of_spheres()) {
    const SphereOctree expected(spheres, 2);
    const OctreeArrays found = cuda::octree_on_host(spheres);
    EXPECT_TRUE(same_bytes<OctreeNode>(found.nodes, expected.nodes())) << spheres.size();
    EXPECT_TRUE(same_bytes<std::uint32_t>(found.references, expected.references())) << spheres.size();
    nodes += found.nodes.size();
  }
  EXPECT_GT(nodes, 1000u);
}

TEST(OctreeDevice, LookUpsListWhatHoldsAPoint) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.1, 1.1);
  std::size_t found = 0;
  for (const std::vector<Sphere>& spheres : kinds_of_spheres()) {
    std::vector<OctreePoint> points;
    for (int k = 0; k < 1000; ++k) {
      const double scale = k % 2 == 0 ? 1 : 0.1;
      const double x = scale * place(random), y = scale * place(random);
      points.push_back({x, y, scale * place(random)});
    }
    const HoldingSpheres holding = cuda::look_up_on_host(SphereOctree(spheres, 1).view(), spheres, points);
    ASSERT_EQ(holding.first.size(), points.size() + 1);
    ASSERT_EQ(holding.first.back(), holding.spheres.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t s = 0; s < spheres.size(); ++s)
        if (holds(spheres[s], points[k])) expected.push_back(s);
      ASSERT_EQ(std::vector<std::uint32_t>(holding.spheres.begin() + holding.first[k],
                                           holding.spheres.begin() + holding.first[k + 1]),
                expected)
          << k;
      found += expected.size();
    }
  }
  EXPECT_GT(found, 10000u);
}

TEST(OctreeDevice, WithoutAGpuItSaysSo) {
  std::string why;
  if (!cuda::find_devices(why).empty()) GTEST_SKIP() << "there is one";
  EXPECT_THROW(cuda::DeviceOctree({}, 0, 0), cuda::DeviceError);
}

}  // namespace
}  // namespace fluxel

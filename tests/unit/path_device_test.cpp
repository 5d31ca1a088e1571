#include "reference/path_device.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/sampling.hpp"
#include "reference/cuda/host_paths.hpp"
#include "tests/unit/test_scenes.hpp"
#include "visibility/cuda/first_side.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::random_plates;

/// Paths from points of all surfaces, from both of their sides.
std::vector<PathStart> starts_on(const Scene& scene, std::uint32_t count) {
  std::vector<PathStart> starts;
  for (std::uint32_t k = 0; k < count; ++k) {
    OwenSobol numbers(random_bits(k % 16), k / 16);
    const auto [s, t, u, v] = numbers.next();
    const Piece& piece = scene.pieces[(std::size_t{k} * 2654435761u >> 7) % scene.pieces.size()];
    const glm::dvec3& normal = scene.patch(piece.patch).normal;
    starts.push_back({{surface_point(piece.outline, s, t), k % 4 > 0 ? normal : -normal}, {u, v}, numbers});
  }
  return starts;
}

/// Paths by the code for devices against those of LightPaths: sines, cosines and sums are the same on the
/// host.
constexpr double kRounding = 1e-12;

void expect_same(const Scene& scene, std::uint32_t count) {
  const RayScene ray_scene(scene, 1);
  const std::vector<PathStart> starts = starts_on(scene, count);
  std::vector<Rgb> expected(count);
  std::uint64_t rays = 0;
  LightPaths(ray_scene).irradiance(starts, expected, rays);
  const cuda::PathArrays arrays = path_arrays(ray_scene);
  std::vector<cuda::PathBegin> begins;
  for (const PathStart& start : starts) begins.push_back(path_begin(start));
  const std::vector<cuda::PathEstimate> found = cuda::HostPaths(arrays).follow(begins);
  std::uint64_t rays_found = 0;
  std::uint32_t lit = 0, different = 0;
  for (std::size_t k = 0; k < count; ++k) {
    rays_found += found[k].rays;
    const auto& [x, y, z] = found[k].irradiance;
    const Rgb irradiance(x, y, z);
    lit += expected[k] != Rgb(0) ? 1 : 0;
    for (int c = 0; c < kChannels; ++c)
      if (!(std::abs(irradiance[c] - expected[k][c]) <= kRounding * std::abs(expected[k][c]))) ++different;
  }
  EXPECT_EQ(different, 0u) << "channels of " << count << " paths";
  EXPECT_EQ(rays_found, rays);
  EXPECT_GT(lit, count / 10);
  EXPECT_GT(rays, 2 * std::uint64_t{count});
}

TEST(PathDevice, ScenesOfTheProject) {
  for (const char* name : {"cornell-box", "construction-in-wood", "office-2391"}) {
    SCOPED_TRACE(name);
    expect_same(test_scenes::load(name, 8, 8).scene, 20000);
  }
}

// Plates through each other, of which some shine, in a room: channels differ, and so do both sides.
TEST(PathDevice, Clutter) {
  for (const unsigned seed : {1u, 2u}) {
    Scene scene = random_plates(60, 0.6, seed == 1 ? Sides::one : Sides::two, seed);
    by_hand::add(scene, "lamp", {{-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}, {1, -1, 1}}, by_hand::kLight);
    by_hand::add_box(scene, "room", glm::dvec3(-3), glm::dvec3(3), false);
    scene.materials[0].rho = {0.8, 0.5, 0.3};
    scene.pieces.clear();
    expect_same(finished(std::move(scene)), 20000);
  }
}

// A lamp, a dark sheet and a two-sided one lie in the floor: all of them, and the floor, are met at one
// place.
TEST(PathDevice, CoincidingPatches) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "room", {-1, -1, 0}, {1, 1, 2}, false);
  by_hand::add(scene, "dark", {{-0.8, -0.8, 0}, {-0.8, 0, 0}, {0, 0, 0}, {0, -0.8, 0}});
  by_hand::add(scene, "lamp", {{0.2, 0.2, 0}, {0.8, 0.2, 0}, {0.8, 0.8, 0}, {0.2, 0.8, 0}}, by_hand::kLight);
  scene.pieces.clear();
  scene = finished(std::move(scene));
  // As if the floor's area under the others had been taken from it.
  auto& corner = scene.pieces.front().outline.corner;
  corner[1] = 0.5 * (corner[0] + corner[1]);
  corner[2] = 0.5 * (corner[3] + corner[2]);
  const cuda::PathArrays arrays = path_arrays(RayScene(scene, 1));
  ASSERT_NE(arrays.flags[0] & cuda::kCovered, 0);
  expect_same(scene, 20000);
}

}  // namespace
}  // namespace fluxel

#include "visibility/cuda/nearest_hit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/test_scenes.hpp"
#include "visibility/device_scene.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::random_plates;
using test_scenes::uniform;

/// Of a patch: a corner, a point of an edge, or one within.
glm::dvec3 point_of_patch(const Patch& patch, std::mt19937& random) {
  const Outline<glm::dvec3>& outline = patch.outline;
  const std::size_t c = random() % outline.corners;
  const auto corner = [&](std::size_t step) { return outline.corner[(c + step) % outline.corners]; };
  const double along = random() % 3 == 0 ? 0 : random() % 2 == 0 ? 0.5 : uniform(random, 0, 1);
  const glm::dvec3 at = corner(0) + along * (corner(1) - corner(0));
  return random() % 2 == 0 ? at : at + uniform(random, 0, 0.5) * (0.5 * (corner(2) + corner(3)) - at);
}

/// From within, from the surfaces themselves, from outside and from very far away, to points of patches,
/// along the axes, and anywhere.
Ray ray_of(const Scene& scene, std::mt19937& random) {
  const auto any_patch = [&]() -> const Patch& { return scene.patches[random() % scene.patches.size()]; };
  const glm::dvec3 near = test_scenes::uniform_point(random, -scene.extent, scene.extent);
  const glm::dvec3 to = point_of_patch(any_patch(), random);
  switch (random() % 6) {
    case 0:
      return {near, test_scenes::random_direction(random)};
    case 1:
      return {near, to - near};
    case 2: {
      const glm::dvec3 from = point_of_patch(any_patch(), random);
      return {from, from == to ? glm::dvec3(0, 0, 1) : to - from};
    }
    case 3: {
      const glm::dvec3 far = std::pow(10.0, uniform(random, 0.5, 7)) * near;
      return {far, to - far};
    }
    case 4: {
      glm::dvec3 axis(0);
      axis[static_cast<int>(random() % 3)] = random() % 2 == 0 ? 1 : -1;
      return {to - 1.5 * scene.extent * axis, axis};
    }
    default:
      return {10.0 * near, test_scenes::random_direction(random)};
  }
}

cuda::Double3 vector_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// What single precision, in which Embree compares distances, tells apart, of the scene's extent.
constexpr double kTie = 1e-5;

/// Whether a ray meets a patch where Embree, in single precision, may not see it: at an edge, from its own
/// plane, or along it.
bool is_met_by_rounding(const Patch& patch, const Ray& ray, double t, double tie) {
  const double length = glm::length(ray.direction);
  if (std::abs(glm::dot(patch.normal, ray.direction)) < 1e-7 * length || std::abs(t) * length < tie)
    return true;
  const glm::dvec3 at = ray.origin + t * ray.direction;
  const Outline<glm::dvec3>& outline = patch.outline;
  for (std::size_t c = 0; c < outline.corners; ++c) {
    const glm::dvec3 edge = outline.corner[(c + 1) % outline.corners] - outline.corner[c];
    if (std::abs(glm::dot(glm::cross(patch.normal, edge), at - outline.corner[c])) < tie * glm::length(edge))
      return true;
  }
  return false;
}

/// How hits of one scene compare.
struct HitComparison {
  int rays = 0, met = 0;
  int wrong = 0;        // other than by brute force
  int ties = 0;         // another patch than Embree's, at the same place in single precision
  int by_rounding = 0;  // another, as one of the two is met by rounding
  int different = 0;    // from Embree's otherwise
};

constexpr int kRays = 6000;

HitComparison compare(const Scene& scene, unsigned seed) {
  const RayScene ray_scene(scene, 1);
  const cuda::SceneArrays arrays = device_scene(ray_scene, {});
  const cuda::TileScene view = arrays.view();
  const double tie = kTie * scene.extent;
  std::mt19937 random(seed);
  HitComparison sum;
  for (; sum.rays < kRays; ++sum.rays) {
    const Ray ray = ray_of(scene, random);
    const cuda::Ray traced{vector_of(ray.origin), vector_of(ray.direction)};
    const cuda::NearestHit found = cuda::nearest_hit(view, traced);
    const cuda::NearestHit forced =
        cuda::nearest_hit(view, traced, [&](const cuda::TracedRay&, cuda::NearestPatch& nearest) {
          for (std::uint32_t patch = 0; patch < view.patches; ++patch)
            nearest.look_at(view.exact[patch], patch);
        });
    sum.wrong += found.patch != forced.patch || cuda::bits_of(found.t) != cuda::bits_of(forced.t) ? 1 : 0;
    const PatchHit embree = ray_scene.first_hit(ray.origin, ray.direction);
    const bool is_met = found.patch != cuda::kNoHit;
    const PatchId patch = is_met ? PatchId{view.exact[found.patch].number} : kNoPatch;
    sum.met += is_met ? 1 : 0;
    const auto by_rounding = [&](PatchId of, double t) {
      return of != kNoPatch && is_met_by_rounding(scene.patch(of), ray, t, tie);
    };
    // Of a patch in whose plane a ray lies, t is what rounding makes of it.
    if (patch == embree.patch && cuda::bits_of(found.t) == cuda::bits_of(embree.t)) continue;
    if (is_met && embree.patch != kNoPatch && std::abs(found.t - embree.t) * glm::length(ray.direction) < tie)
      ++sum.ties;
    else if (by_rounding(patch, found.t) || by_rounding(embree.patch, embree.t))
      ++sum.by_rounding;
    else
      ++sum.different;
  }
  return sum;
}

/// Boxes that touch and rays aimed at their edges have the most: 217 and 128 of 6,000.
constexpr int kMostTies = kRays / 20, kMostByRounding = kRays / 40;

void expect_same(const Scene& scene, unsigned seed) {
  const HitComparison found = compare(scene, seed);
  EXPECT_EQ(found.wrong, 0) << "of " << found.rays;
  EXPECT_EQ(found.different, 0) << "of " << found.rays;
  EXPECT_LE(found.ties, kMostTies);
  EXPECT_LE(found.by_rounding, kMostByRounding);
  EXPECT_GT(found.met, found.rays / 5);
  EXPECT_LT(found.met, found.rays);
}

TEST(NearestHit, Clutter) {
  expect_same(random_plates(40, 0.6, Sides::one, 1), 1);
  expect_same(random_plates(1500, 0.1, Sides::two, 2), 2);
}

TEST(NearestHit, CubesOnALattice) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "room", glm::dvec3(-2), glm::dvec3(2), false);
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0})
      for (const double z : {-1.5, -0.5, 0.5})
        by_hand::add_box(scene, "cube", {x - 0.25, y - 0.25, z - 0.25}, {x + 0.25, y + 0.25, z + 0.25}, true);
  expect_same(finished(std::move(scene)), 3);
}

TEST(NearestHit, BoxesThatTouch) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "room", {-2, -1.5, -1}, {2, 1.5, 1}, false);
  by_hand::add_box(scene, "standing", {-1, -1, -1}, {0, 0, 0}, true);
  by_hand::add_box(scene, "on top", {-0.75, -0.75, 0}, {-0.25, -0.25, 0.5}, true);
  by_hand::add_box(scene, "beside", {0, -1, -1}, {0.5, 0, -0.5}, true);
  by_hand::add_box(scene, "edge to edge", {0.5, 0, -1}, {1, 0.5, 0}, true);
  by_hand::add_box(scene, "corner", {1.5, 1, -1}, {2, 1.5, 0.5}, true);
  expect_same(finished(std::move(scene)), 4);
}

TEST(NearestHit, Slivers) {
  std::mt19937 random(7);
  Scene scene = by_hand::empty_scene(Sides::two);
  for (int k = 0; k < 150; ++k) {
    const glm::dvec3 at = test_scenes::uniform_point(random, -1, 1);
    const glm::dvec3 along = test_scenes::random_direction(random);
    const double width = std::pow(10.0, -1 - 3 * uniform(random, 0, 1));
    const glm::dvec3 across =
        width * glm::normalize(glm::cross(along, test_scenes::random_direction(random)));
    by_hand::add(scene, "sliver", {at, at + along, at + 0.3 * along + across});
  }
  expect_same(finished(std::move(scene)), 5);
}

TEST(NearestHit, ScenesOfTheProject) {
  for (const char* name : {"cornell-box", "construction-in-wood", "office-2391"}) {
    SCOPED_TRACE(name);
    expect_same(test_scenes::load(name, 8, 8).scene, 6);
  }
}

// The lower patch of two at one place, wherever the tree has them.
TEST(NearestHit, CoincidingPatchesGoByTheirNumber) {
  Scene scene = random_plates(200, 0.2, Sides::two, 8);
  const std::size_t first = scene.patches.size();
  for (int copy = 0; copy < 12; ++copy)
    by_hand::add(scene, "sheet", {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}});
  scene.pieces.clear();
  scene = finished(std::move(scene));
  const cuda::SceneArrays arrays = device_scene(RayScene(scene, 1), {});
  const cuda::NearestHit found = cuda::nearest_hit(arrays.view(), {{0.1, 0.2, 3}, {0, 0, -1}});
  ASSERT_NE(found.patch, cuda::kNoHit);
  EXPECT_EQ(arrays.exact[found.patch].number, first);
  EXPECT_EQ(found.t, 1);
}

TEST(NearestHit, NothingIsMetInAnEmptyScene) {
  const cuda::SceneArrays arrays({}, {}, 1, 0);
  EXPECT_EQ(cuda::nearest_hit(arrays.view(), {{0, 0, 0}, {0, 0, 1}}).patch, cuda::kNoHit);
}

}  // namespace
}  // namespace fluxel

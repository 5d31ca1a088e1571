#include "visibility/ray_scene.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "scene/contact_pairs.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::uniform;

/// Squares of side 2 around the z axis at the given heights, normals up.
Scene stack(const std::vector<double>& heights) {
  Scene scene = by_hand::empty_scene(Sides::one);
  for (const double z : heights)
    by_hand::add(scene, "plate", {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}});
  return finished(std::move(scene));
}

TEST(RayScene, TheNearerPatchIsHitFromBothSides) {
  const Scene scene = stack({0, 1});
  const RayScene rays(scene, 1);
  const PatchHit from_above = rays.first_hit({0.25, 0.5, 3}, {0, 0, -1});
  EXPECT_EQ(from_above.patch, PatchId{1});
  EXPECT_DOUBLE_EQ(from_above.t, 2);
  const PatchHit from_below = rays.first_hit({0.25, 0.5, -3}, {0, 0, 2});
  EXPECT_EQ(from_below.patch, PatchId{0});
  EXPECT_DOUBLE_EQ(from_below.t, 1.5) << "a direction need not be normalised";
  EXPECT_EQ(rays.first_hit({0.25, 0.5, 3}, {0, 0, 1}).patch, kNoPatch);
  EXPECT_EQ(rays.first_hit({1.5, 0.5, 3}, {0, 0, -1}).patch, kNoPatch);
}

TEST(RayScene, DistancesAreInDoublePrecision) {
  const double height = 1 + 1e-10;  // single precision takes it as 1
  const Scene scene = stack({height});
  const RayScene rays(scene, 1);
  EXPECT_NEAR(rays.first_hit({0.3, 0.1, 2}, {0, 0, -1}).t, 2 - height, 1e-15);
  std::vector<PatchHit> hits;
  rays.all_hits({0.3, 0.1, 2}, {0, 0, -1}, 5, hits);
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_NEAR(hits[0].t, 2 - height, 1e-15);
}

TEST(RayScene, AFarOriginCostsNoDigits) {
  const Scene scene = stack({0, 1});
  const RayScene rays(scene, 1);
  std::mt19937 random(5);
  for (const double distance : {1e3, 1e6, 1e9}) {
    for (int k = 0; k < 100; ++k) {
      // Just inside and just outside an edge of the upper plate.
      const glm::dvec3 direction =
          glm::normalize(glm::dvec3(uniform(random, -1, 1), uniform(random, -1, 1), -2));
      for (const double x : {1 - 1e-5, 1 + 1e-5}) {
        const glm::dvec3 target(x, 0.5, 1);
        const PatchHit hit = rays.first_hit(target - distance * direction, direction);
        EXPECT_EQ(hit.patch == PatchId{1}, x < 1) << distance;
        std::vector<PatchHit> hits;
        rays.all_hits(target - distance * direction, direction, distance + 0.1, hits);
        EXPECT_EQ(hits.empty(), x > 1) << distance;
        if (x < 1) {
          EXPECT_NEAR(hit.t, distance, 1e-15 * distance);
        }
      }
      EXPECT_EQ(rays.first_hit(glm::dvec3(0, 0, 1) - distance * direction, -direction).patch, kNoPatch);
    }
  }
}

TEST(RayScene, AllHitsGivesEveryPatchUpToTheEnd) {
  const Scene scene = stack({3, 0, 1, 2, 2});
  const RayScene rays(scene, 1);
  std::vector<PatchHit> hits;
  rays.all_hits({0.3, 0.1, 4}, {0, 0, -1}, 3.5, hits);
  std::ranges::sort(hits, {}, &PatchHit::patch);
  ASSERT_EQ(hits.size(), 4u);
  const std::vector<std::pair<PatchId, double>> expected{
      {PatchId{0}, 1}, {PatchId{2}, 3}, {PatchId{3}, 2}, {PatchId{4}, 2}};
  for (std::size_t k = 0; k < hits.size(); ++k) {
    EXPECT_EQ(hits[k].patch, expected[k].first);
    EXPECT_DOUBLE_EQ(hits[k].t, expected[k].second);
  }
}

TEST(RayScene, WithoutPatchesNothingIsHit) {
  const Scene scene = stack({0});
  const RayScene rays(scene, std::span<const PatchId>{}, 1);
  EXPECT_EQ(rays.first_hit({0, 0, 1}, {0, 0, -1}).patch, kNoPatch);
  std::vector<PatchHit> hits;
  rays.all_hits({0, 0, 1}, {0, 0, -1}, 10, hits);
  EXPECT_TRUE(hits.empty());
  RayPacket packet{};
  packet.origin_z.fill(1);
  packet.direction_z.fill(-10);
  EXPECT_EQ(rays.occluded(packet, RayPacket::kSize), 0u);
}

TEST(RayScene, OnlyListedPatchesAreHitAndKeepTheirNumbers) {
  const Scene scene = stack({3, 2, 1});
  const std::vector<PatchId> listed{PatchId{2}, PatchId{1}};
  const RayScene rays(scene, listed, 1);
  EXPECT_EQ(rays.first_hit({0.1, 0.2, 4}, {0, 0, -1}).patch, PatchId{1});
  EXPECT_EQ(rays.first_hit({0.1, 0.2, 0}, {0, 0, 1}).patch, PatchId{2});
}

TEST(RayScene, PacketsTellEachSegmentAndObserveItsEnds) {
  const Scene scene = stack({0});
  const RayScene rays(scene, 1);
  for (int count = 1; count <= RayPacket::kSize; ++count) {
    RayPacket packet{};
    std::uint32_t expected = 0;
    for (int k = 0; k < count; ++k) {
      const float x = k % 3 == 0 ? 5.0f : 0.25f;      // beside the plate
      const float start = k % 5 == 1 ? -0.5f : 2.0f;  // behind the plate
      const float end = k % 7 == 2 ? 0.5f : -1.0f;    // before it
      packet.set_segment(k, {x, 0, start}, {x, 0, end});
      if (k % 3 != 0 && k % 5 != 1 && k % 7 != 2) expected |= 1u << k;
    }
    EXPECT_EQ(rays.occluded(packet, count), expected) << count;
  }
}

TEST(RayScene, ARayThatIsNotFiniteNeverReachesEmbree) {
  const Scene scene = stack({0});
  const RayScene rays(scene, 1);
  constexpr float kLimit = std::numeric_limits<float>::infinity();
  std::vector<PatchHit> hits;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kLimit, -kLimit, 2e18f}) {
    for (const int count : {1, 4, 5, 8, 9, 16}) {
      RayPacket packet{};
      for (int k = 0; k < RayPacket::kSize; ++k) packet.set_segment(k, {0.25f, 0, 2}, {0.25f, 0, -1});
      EXPECT_EQ(rays.occluded(packet, count), (1u << count) - 1);
      packet.set_segment(count - 1, {0.25f, bad, 2}, {0.25f, 0, -1});
      EXPECT_THROW(static_cast<void>(rays.occluded(packet, count)), UntraceableRay) << bad << " of " << count;
    }
    const double wide = static_cast<double>(bad);
    EXPECT_THROW(static_cast<void>(rays.first_hit({0, 0, 1}, {0, wide, -1})), UntraceableRay) << bad;
    EXPECT_THROW(rays.all_hits({0, 0, 1}, {0, wide, -1}, 5, hits), UntraceableRay) << bad;
  }
  EXPECT_THROW(rays.all_hits({0, 0, 1}, {0, 0, -1}, std::numeric_limits<double>::quiet_NaN(), hits),
               UntraceableRay);
}

// Rays along edges and through corners of a lattice: Embree alone answers by the company they keep.
TEST(RayScene, ASegmentsAnswerDoesNotDependOnItsPacket) {
  std::mt19937 random(6);
  Scene scene = by_hand::empty_scene(Sides::two);
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0})
      by_hand::add_box(scene, "cube", {x - 0.25, y - 0.25, -0.25}, {x + 0.25, y + 0.25, 0.25}, true);
  scene = finished(std::move(scene));
  const RayScene rays(scene, 1);
  const auto on_lattice = [&] {
    return glm::vec3(glm::round(test_scenes::uniform_point(random, -8, 8)) * 0.25 + glm::dvec3(0.125, 0, 0));
  };
  int hidden = 0, different = 0;
  for (int repeat = 0; repeat < 5000; ++repeat) {
    RayPacket together, alone;
    std::uint32_t expected = 0;
    const int count = 1 + repeat % RayPacket::kSize;
    for (int k = 0; k < count; ++k) {
      const glm::vec3 from = on_lattice(), to = on_lattice();
      together.set_segment(k, from, to);
      alone.set_segment(0, from, to);
      expected |= rays.occluded(alone, 1) << k;
    }
    hidden += std::popcount(expected);
    different += rays.occluded(together, count) != expected ? 1 : 0;
  }
  EXPECT_EQ(different, 0);
  EXPECT_GT(hidden, 10'000);
}

// Seen from afar, a sliver's plane is known to single precision over its width.
TEST(RayScene, ASliverDoesNotHideItsOwnPoints) {
  std::mt19937 random(5);
  int hidden = 0, crossing = 0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::two);
    by_hand::add(scene, "sliver", {{0, 0, 0}, {1, 0, 0}, {0.3, 1e-4, 0}});
    by_hand::rotate(scene, by_hand::random_rotation(random));
    Patch& patch = scene.patches[0];
    const glm::dvec3 shift = test_scenes::uniform_point(random, -5, 5);
    for (glm::dvec3& x : patch.outline.corner) x += shift;
    scene = finished(std::move(scene));
    const RayScene rays(scene, 1);
    const glm::dvec3 on = centroid(corners(scene.patches[0].outline));
    const glm::dvec3 normal = scene.patches[0].normal;
    const double epsilon = rays.surface_epsilon();
    glm::dvec3 away = test_scenes::random_direction(random);
    if (glm::dot(away, normal) < 0) away = -away;
    RayPacket packet{};
    packet.set_segment(0, glm::vec3(on + 8.0 * away), glm::vec3(on + epsilon * normal));
    packet.set_segment(1, glm::vec3(on + 8.0 * normal), glm::vec3(on - 8.0 * normal));
    const std::uint32_t bits = rays.occluded(packet, 2);
    hidden += (bits & 1u) != 0 ? 1 : 0;
    crossing += (bits & 2u) != 0 ? 1 : 0;
  }
  EXPECT_EQ(hidden, 0);
  EXPECT_GT(crossing, 150);
}

TEST(RayScene, TheEpsilonGrowsWithTheScene) {
  // Edges are 2 m at least, so that the contact tolerance is nowhere the scene's extent alone.
  for (const double height : {4.0, 4000.0}) {
    const Scene scene = stack({0, height});
    const double expected = contact_tolerance(scene) + 4 * height * 0x1p-23;
    EXPECT_FLOAT_EQ(RayScene(scene, 1).surface_epsilon(), static_cast<float>(expected));
    EXPECT_GT(contact_tolerance(scene), 0);
  }
  EXPECT_GT(RayScene(stack({0, 4000}), 1).surface_epsilon(),
            10 * RayScene(stack({0, 4}), 1).surface_epsilon());
}

/// Which of three two-sided sheets see each other.
struct SheetsInSight {
  bool first_second, first_third, second_third;
};

/// The second lies above the first by so many least gaps, the third far above both; turned and moved at
/// random.
SheetsInSight sheets_in_sight(double gaps, std::mt19937& random) {
  const glm::dquat rotation = by_hand::random_rotation(random);
  const glm::dvec3 shift = test_scenes::uniform_point(random, -1, 1);
  const auto stacked = [&](double height) {
    Scene scene = by_hand::empty_scene(Sides::two);
    for (const double z : {0.0, height, 3.0})
      by_hand::add(scene, "sheet", {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}});
    by_hand::rotate(scene, rotation);
    for (Patch& patch : scene.patches)
      for (glm::dvec3& x : patch.outline.corner) x += shift;
    return finished(std::move(scene));
  };
  const Scene scene = stacked(gaps * least_gap(stacked(0)));
  const RayScene rays(scene, 1);
  const ElementMesh mesh = test_scenes::uniform_elements(scene, test_scenes::kUnbounded);
  EXPECT_EQ(mesh.elements.size(), 3u);
  const TracedTile tile = TileTracer(rays, mesh.elements).trace(0, 0);
  const auto sees = [&](std::size_t i, std::size_t j) { return (tile.bits[i] >> j & 1u) != 0; };
  return {sees(0, 1), sees(0, 2), sees(1, 2)};
}

TEST(RayScene, SheetsAreToldApartFromTheLeastGapOnAndNotAtAFractionOfIt) {
  std::mt19937 random(23);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const SheetsInSight apart = sheets_in_sight(1, random);
    EXPECT_TRUE(apart.first_second);
    EXPECT_FALSE(apart.first_third) << "the second hides the first";
    EXPECT_TRUE(apart.second_third);
    EXPECT_FALSE(sheets_in_sight(0.6, random).first_second);
    const SheetsInSight as_one = sheets_in_sight(0.2, random);
    EXPECT_FALSE(as_one.first_second);
    EXPECT_TRUE(as_one.first_third) << "the first looks through the second";
    EXPECT_TRUE(as_one.second_third);
  }
}

// Just inside and just outside an edge with another plate behind it, past both, and from far away.
TEST(RayScene, RaysOfAPacketMeetWhatTheyMeetAlone) {
  const Scene scene = stack({0, 1});
  const RayScene rays(scene, 1);
  std::mt19937 random(6);
  for (const std::size_t count : {1u, 4u, 7u, 16u, 333u}) {
    std::vector<Ray> all;
    for (std::size_t k = 0; k < count; ++k) {
      const glm::dvec3 direction(uniform(random, -1, 1), uniform(random, -1, 1), -2);
      const glm::dvec3 target(std::array{1 - 1e-5, 1 + 1e-5, 0.3, 3.0}[k % 4], 0.5, 1);
      all.push_back({target - (k % 5 == 0 ? 1e6 : 1.5) * direction, direction});
    }
    std::vector<PatchHit> hits(count);
    rays.first_hits(all, hits);
    for (std::size_t k = 0; k < count; ++k) {
      const PatchHit alone = rays.first_hit(all[k].origin, all[k].direction);
      EXPECT_EQ(hits[k].patch, alone.patch) << k;
      EXPECT_EQ(hits[k].t, alone.t) << k;
      EXPECT_EQ(hits[k].patch == PatchId{1}, k % 4 == 0 || k % 4 == 2) << k;
    }
  }
}

TEST(RayScene, NoRayPassesThroughTheDiagonalOfAParallelogram) {
  std::mt19937 random(3);
  for (int repeat = 0; repeat < 50; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::one);
    const glm::dvec3 a = test_scenes::uniform_point(random, -1, 1),
                     b = a + test_scenes::random_direction(random);
    const glm::dvec3 d = a + 0.7 * test_scenes::random_direction(random);
    by_hand::add(scene, "plate", {a, b, b + d - a, d});
    scene = finished(std::move(scene));
    const RayScene rays(scene, 1);
    const glm::dvec3 normal = scene.patches[0].normal;
    for (int k = 0; k < 400; ++k) {
      const glm::dvec3 target = a + uniform(random, 0.01, 0.99) * (b + d - 2.0 * a);
      const glm::dvec3 from =
          target + uniform(random, 0.2, 2) * normal + 0.3 * test_scenes::random_direction(random);
      ASSERT_EQ(rays.first_hit(from, target - from).patch, PatchId{0});
    }
  }
}

TEST(RayScene, NoRayLeavesAClosedBox) {
  std::mt19937 random(4);
  int lost = 0, lost_in_packets = 0;
  for (int repeat = 0; repeat < 10; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add_box(scene, "box", {-1, -0.7, -0.4}, {1, 0.7, 0.4}, false);
    const glm::dquat rotation = by_hand::random_rotation(random);
    by_hand::rotate(scene, rotation);
    scene = finished(std::move(scene));
    const RayScene rays(scene, 1);
    RayPacket packet{};
    for (int k = 0; k < 10'000; ++k) {
      const glm::dvec3 from =
          rotation * (test_scenes::uniform_point(random, -0.9, 0.9) * glm::dvec3(1, 0.7, 0.4));
      glm::dvec3 direction = test_scenes::random_direction(random);
      if (k % 2 == 0) {  // aimed at an edge between two faces
        glm::dvec3 target = test_scenes::uniform_point(random, -1, 1);
        target[k / 2 % 3] = k % 4 == 0 ? 1 : -1;
        target[(k / 2 + 1) % 3] = k % 8 < 4 ? 1 : -1;
        direction = rotation * (target * glm::dvec3(1, 0.7, 0.4)) - from;
      }
      lost += rays.first_hit(from, direction).patch == kNoPatch ? 1 : 0;
      const int lane = k % RayPacket::kSize;
      packet.set_segment(lane, glm::vec3(from), glm::vec3(from + 100.0 * direction));
      if (lane + 1 == RayPacket::kSize)
        lost_in_packets += RayPacket::kSize - std::popcount(rays.occluded(packet, RayPacket::kSize));
    }
  }
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(lost_in_packets, 0);
}

// Segments through edges of tiles of a wall, which differ in size by five, in a hall of 10 m; down to 0.2
// degrees.
TEST(RayScene, NothingPassesBetweenTheTilesOfAWall) {
  std::mt19937 random(8);
  std::size_t lost = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::one);
    const int tiles = repeat % 2 == 0 ? 30 : 6;
    const double edge = 3.0 / tiles;
    const auto place = [&](int i) { return edge * i - 1.5; };
    for (int i = 0; i < tiles; ++i) {
      for (int j = 0; j < tiles; ++j) {
        const glm::dvec3 a(place(i), place(j), 0), b(place(i + 1), place(j), 0);
        const glm::dvec3 c(place(i + 1), place(j + 1), 0), d(place(i), place(j + 1), 0);
        by_hand::add(scene, "tile", {a, b, c});
        by_hand::add(scene, "tile", {a, c, d});
      }
    }
    by_hand::add(scene, "far away", {{-5, -5, -5}, {-4.9, -5, -5}, {-5, -4.9, -5}});
    by_hand::add(scene, "far away", {{5, 5, 5}, {4.9, 5, 5}, {5, 4.9, 5}});
    const glm::dquat rotation = by_hand::random_rotation(random);
    by_hand::rotate(scene, rotation);
    scene = finished(std::move(scene));
    const RayScene rays(scene, 1);
    RayPacket packet{};
    for (int k = 0; k < 16'000; ++k) {
      const double s = uniform(random, -1.4, 1.4), t = place(1 + static_cast<int>(random() % 5) * tiles / 6);
      const std::array edges{glm::dvec3(s, t, 0), glm::dvec3(t, s, 0), glm::dvec3(s, s, 0)};
      const double sine = std::pow(10.0, uniform(random, -2.5, 0)), turn = uniform(random, 0, 6.3);
      const glm::dvec3 along = uniform(random, 0.5, 3) * glm::dvec3(std::cos(turn), std::sin(turn), sine);
      const glm::dvec3 from = edges[random() % 3] - uniform(random, 0.2, 0.8) * along;
      packet.set_segment(k % RayPacket::kSize, glm::vec3(rotation * from),
                         glm::vec3(rotation * (from + along)));
      if (k % RayPacket::kSize == RayPacket::kSize - 1)
        lost += static_cast<std::size_t>(RayPacket::kSize -
                                         std::popcount(rays.occluded(packet, RayPacket::kSize)));
    }
  }
  EXPECT_EQ(lost, 0U);
}

}  // namespace
}  // namespace fluxel

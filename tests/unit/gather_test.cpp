#include "hierarchy/gather.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "formfactor/free_segments.hpp"
#include "formfactor/view_factor.hpp"
#include "hierarchy/far_light.hpp"
#include "hierarchy/node_light.hpp"
#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::RefinedTree;

/// A refined scene, the light of its leaves, and points on leaves.
struct Lit {
  Lit(const RefinedTree& of, std::vector<Rgb> of_leaves)
      : made(of), table(of.tree, of.links), B(of.tree.size()), slopes(of.tree.size(), {Rgb(0), Rgb(0)}) {
    const std::vector<NodeId> leaves = made.leaves();
    for (std::size_t k = 0; k < leaves.size(); ++k) B[leaves[k]] = of_leaves[k];
    pull(made.tree, std::span(B));
  }

  [[nodiscard]] std::vector<Rgb> gather(std::span<const GatherPoint> points, const GatherGoal& goal) const {
    const Gatherer gatherer(made.ray_scene, made.tree, table, B, slopes, goal);
    std::vector<std::uint64_t> sums(kChannels * points.size());
    rays = gather_all(gatherer, points, sums);
    return in_watts(gatherer, sums);
  }

  /// Points of one leaf together, as many as may be.
  static std::uint64_t gather_all(const Gatherer& gatherer, std::span<const GatherPoint> points,
                                  std::span<std::uint64_t> sums) {
    std::map<NodeId, std::vector<std::uint32_t>> of_leaves;
    std::uint64_t rays = 0;
    const auto gather = [&](std::vector<std::uint32_t>& numbers) {
      rays += gatherer.gather(points, numbers, 0, sums);
      numbers.clear();
    };
    for (std::uint32_t k = 0; k < points.size(); ++k) {
      if (points[k].face == kNoNode) continue;
      std::vector<std::uint32_t>& numbers = of_leaves[points[k].face];
      numbers.push_back(k);
      if (numbers.size() == PointGroup::kSize) gather(numbers);
    }
    for (auto& [leaf, numbers] : of_leaves)
      if (!numbers.empty()) gather(numbers);
    return rays;
  }

  static std::vector<Rgb> in_watts(const Gatherer& gatherer, std::span<const std::uint64_t> sums) {
    std::vector<Rgb> H(sums.size() / kChannels);
    for (std::size_t k = 0; k < H.size(); ++k)
      for (int c = 0; c < kChannels; ++c)
        H[k][c] =
            gatherer.unit() *
            static_cast<double>(static_cast<std::int64_t>(sums[kChannels * k + static_cast<std::size_t>(c)]));
    return H;
  }

  /// A sum over all leaves, each seen by so many rays on a grid.
  [[nodiscard]] Rgb brute_force(const GatherPoint& point, int along) const {
    Rgb sum(0);
    const glm::dvec3 normal = made.tree[point.face].shape.normal;
    for (const NodeId leaf : made.leaves()) {
      const FlatShape& shape = made.tree[leaf].shape;
      if (glm::dot(shape.normal, point.position - shape.centroid) <= 1e-9) continue;
      const double F = point_to_polygon(point.position, normal, corners(made.tree.outline(leaf)));
      if (F <= 0) continue;
      double all = 0, seen = 0;
      for (int k = 0; k < along * along; ++k) {
        const SurfaceSegment segment{
            point.position, normal,
            surface_point(made.tree.outline(leaf), (k % along + 0.5) / along, (k / along + 0.5) / along),
            shape.normal};
        const glm::dvec3 d = segment.to - segment.from;
        const double r2 = glm::dot(d, d);
        const double weight = std::max(0.0, glm::dot(normal, d)) * -glm::dot(shape.normal, d) / (r2 * r2);
        all += weight;
        if (weight > 0 && free_segments(made.ray_scene, {&segment, 1}) != 0) seen += weight;
      }
      if (all > 0) sum += F * seen / all * B[leaf];
    }
    return sum;
  }

  const RefinedTree& made;
  LinkTable table;
  std::vector<Rgb> B;
  std::vector<std::array<Rgb, 2>> slopes;
  mutable std::uint64_t rays = 0;
};

/// Points of leaves, a little inside.
std::vector<GatherPoint> points_on(const RefinedTree& made, int count, unsigned seed) {
  std::mt19937 random(seed);
  const std::vector<NodeId> leaves = made.leaves();
  std::vector<GatherPoint> points;
  for (int k = 0; k < count; ++k) {
    const NodeId leaf = leaves[random() % leaves.size()];
    points.push_back({leaf, test_scenes::random_point(made.tree, leaf, random)});
  }
  return points;
}

std::vector<Rgb> random_light(const RefinedTree& made, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Rgb> B(made.leaves().size());
  for (Rgb& value : B) value = test_scenes::uniform_point(random, 0.5, 1.5);
  return B;
}

TEST(Gather, OneWallOfACubeLightsTheOthersAsItsSolidAngle) {
  const RefinedTree cube(test_scenes::unit_cube(), 1e-3);
  std::vector<Rgb> B;
  const NodeId wall = cube.tree.face(1, true);
  for (const NodeId leaf : cube.leaves())
    B.push_back(test_scenes::is_within(cube.tree, leaf, wall) ? Rgb(1, 2, 4) : Rgb(0));
  const Lit lit(cube, B);
  const std::vector<GatherPoint> points = points_on(cube, 400, 1);
  const std::vector<Rgb> H = lit.gather(points, {1e-3, Rgb(1)});
  EXPECT_EQ(lit.rays, 0U);
  double largest = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double expected = test_scenes::is_within(cube.tree, points[k].face, wall)
                                ? 0
                                : point_to_polygon(points[k].position, cube.tree[points[k].face].shape.normal,
                                                   corners(cube.tree.outline(wall)));
    EXPECT_NEAR(H[k].r, expected, 1e-3);
    EXPECT_NEAR(H[k].g, 2 * H[k].r, 1e-12);
    EXPECT_NEAR(H[k].b, 4 * H[k].r, 1e-12);
    largest = std::max(largest, H[k].r);
  }
  EXPECT_GT(largest, 0.3);
}

TEST(Gather, IsTheSumOverAllLeavesThatAreSeen) {
  const RefinedTree room(test_scenes::room_with_box(), 1e-3);
  const Lit lit(room, random_light(room, 2));
  const std::vector<GatherPoint> points = points_on(room, 60, 3);
  const std::vector<Rgb> H = lit.gather(points, {1e-4, Rgb(1)});
  EXPECT_GT(lit.rays, 0U);
  double squares = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Rgb expected = lit.brute_force(points[k], 12);
    EXPECT_NEAR(H[k].g, expected.g, 0.04);
    squares += std::pow(H[k].g - expected.g, 2);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(points.size())), 0.01);
}

TEST(Gather, ClustersSendByOneFaceOfTheirsAndRightOnAverage) {
  const RefinedTree plates(test_scenes::random_plates(80, 0.15, Sides::two, 4), 1e-2);
  const Lit lit(plates, random_light(plates, 5));
  const std::vector<GatherPoint> points = points_on(plates, 400, 6);
  constexpr int kSeeds = 20;
  double found = 0, expected = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
    for (const Rgb& H : lit.gather(points, {1e-2, Rgb(1), seed})) found += H.g / kSeeds;
  for (const GatherPoint& point : points) expected += lit.brute_force(point, 3).g;
  EXPECT_GT(expected, 0.05 * static_cast<double>(points.size()));
  EXPECT_NEAR(found / expected, 1, 0.03);
}

TEST(Gather, NothingPassesAWall) {
  const RefinedTree closed(test_scenes::squares_and_wall(test_scenes::kWholeWall), 1e-3);
  const Lit dark(closed, std::vector<Rgb>(closed.leaves().size(), Rgb(1)));
  for (const Rgb& H : dark.gather(points_on(closed, 20, 7), {1e-3, Rgb(1)})) EXPECT_EQ(H, Rgb(0));
  const RefinedTree open(test_scenes::squares_and_wall(test_scenes::kNoWall), 1e-3);
  const Lit bright(open, std::vector<Rgb>(open.leaves().size(), Rgb(1)));
  for (const Rgb& H : bright.gather(points_on(open, 20, 7), {1e-3, Rgb(1)})) EXPECT_GT(H.r, 0.1);
}

TEST(Gather, SeedsAndPartsOfTheLinks) {
  const RefinedTree plates(test_scenes::random_plates(60, 0.2, Sides::two, 8), 1e-2);
  const Lit lit(plates, random_light(plates, 9));
  const std::vector<GatherPoint> points = points_on(plates, 200, 10);
  const GatherGoal goal{1e-2, Rgb(1), 1};
  const std::vector<Rgb> H = lit.gather(points, goal);
  EXPECT_EQ(lit.gather(points, goal), H);
  EXPECT_NE(lit.gather(points, {1e-2, Rgb(1), 2}), H);

  // Whoever holds a link, the sums are the same.
  std::vector<std::vector<Link>> of_rank(3);
  for (std::size_t k = 0; k < plates.links.size(); ++k) of_rank[k * 7 % 3].push_back(plates.links[k]);
  std::vector<std::uint64_t> sums(kChannels * points.size());
  double unit = 0;
  for (const std::vector<Link>& links : of_rank) {
    const LinkTable table(plates.tree, links);
    const Gatherer part(plates.ray_scene, plates.tree, table, lit.B, lit.slopes, goal);
    static_cast<void>(Lit::gather_all(part, points, sums));
    unit = part.unit();
  }
  for (std::size_t k = 0; k < points.size(); ++k)
    EXPECT_EQ(unit * static_cast<double>(static_cast<std::int64_t>(sums[kChannels * k])), H[k].r);

  // And whichever points of its leaf a point is gathered with.
  const Gatherer gatherer(plates.ray_scene, plates.tree, lit.table, lit.B, lit.slopes, goal);
  std::vector<std::uint64_t> single(kChannels * points.size());
  for (std::uint32_t k = 0; k < points.size(); ++k)
    static_cast<void>(gatherer.gather(points, std::span(&k, 1), 0, single));
  EXPECT_EQ(Lit::in_watts(gatherer, single), H);
}

TEST(Gather, SingleRaysMeetEveryPartOfASender) {
  // From the middle of one square half of the other is seen, whichever half stands in the dark.
  for (const auto& wall : {test_scenes::kWallOfSmallX, test_scenes::kWallOfSmallY}) {
    RefinedTree made(test_scenes::squares_and_wall(wall), 1);
    made.links = {{made.tree.face(0, true), made.tree.face(1, true), 0.1F, 0, {}, {}, true}};
    const Lit lit(made, {Rgb(1), Rgb(1)});
    // Enough for rays that one point in forty gets: a standard error of 0.0035.
    constexpr std::size_t kPoints = 100'000;
    const std::vector<GatherPoint> points(kPoints, {made.tree.face(0, true), {0.5, 0.5, 0}});
    for (const double error : {0.03, 0.1, 2.0, 10.0}) {
      double mean = 0;
      for (const Rgb& H : lit.gather(points, {error, Rgb(1)})) mean += H.r / static_cast<double>(kPoints);
      EXPECT_NEAR(mean, 0.5 * 0.2395, error > 1 ? 0.015 : 0.005) << error;
    }
  }
}

/// A wall that hides the half of a sender with the smaller x or y from a point below its middle.
struct HalfHidden {
  const std::vector<glm::dvec3>& wall;
  int axis;
};
const std::array kHalves{HalfHidden{test_scenes::kWallOfSmallX, 0},
                         HalfHidden{test_scenes::kWallOfSmallY, 1}};

TEST(Gather, WhatIsSeenOfASenderIsAsBrightAsItIsThere) {
  for (const auto& [wall, axis] : kHalves) {
    // So far away that the sender is taken as a whole.
    Scene scene = test_scenes::squares_and_wall(wall);
    for (Patch& patch : scene.patches)
      for (glm::dvec3& corner : patch.outline.corner) corner.z *= 3;
    for (Piece& piece : scene.pieces) piece.outline = scene.patch(piece.patch).outline;
    RefinedTree made(std::move(scene), 1);
    const NodeId low = made.tree.face(0, true), high = made.tree.face(1, true);
    made.links = {{low, high, 0.1F, 0, {}, {}, true}};
    for (int halving = 0; halving < 3; ++halving) {
      std::vector<NodeId> below = made.leaves();
      std::erase(below, low);
      made.halve(below);
    }
    const glm::dvec3 from(0.5, 0.5, 0);
    const std::vector<GatherPoint> points(20'000, {low, from});
    // Lit are all leaves that the wall leaves open, or one of them.
    for (const std::size_t most_lit : {4U, 1U}) {
      std::vector<Rgb> B;
      double expected = 0;
      std::size_t lit_leaves = 0;
      for (const NodeId leaf : made.leaves()) {
        const bool is_open = leaf != low && made.tree[leaf].shape.centroid[axis] > 0.5;
        B.emplace_back(is_open && lit_leaves < most_lit ? 8.0 / static_cast<double>(most_lit) : 0.0);
        if (B.back() == Rgb(0)) continue;
        ++lit_leaves;
        expected += B.back().r * point_to_polygon(from, {0, 0, 1}, corners(made.tree.outline(leaf)));
      }
      ASSERT_EQ(lit_leaves, most_lit);
      const Lit lit(made, B);
      EXPECT_EQ(lit.B[high], Rgb(1));
      // At the last some hundred rays meet what is lit: 5 % of standard deviation.
      for (const double error : {1e-3, 0.02, 0.5}) {
        double mean = 0;
        for (const Rgb& H : lit.gather(points, {error, Rgb(1)})) mean += H.r / 20'000;
        EXPECT_NEAR(mean / expected, 1, error > 0.1 ? 0.2 : 0.04) << error << ", lit: " << most_lit;
      }
    }
  }
}

TEST(Gather, SlopesOfASender) {
  // Its radiosity is x + 1/2 or y + 1/2, half of it hidden.
  for (const auto& [wall, axis] : kHalves) {
    RefinedTree made(test_scenes::squares_and_wall(wall), 1);
    const NodeId low = made.tree.face(0, true), high = made.tree.face(1, true);
    made.links = {{low, high, 0.1F, 0, {}, {}, true}};
    Lit lit(made, {Rgb(1), Rgb(1)});
    const glm::dvec2 extent = made.tree[high].extent;
    lit.slopes[high] = {Rgb(extent.x * made.tree.axes(high).u[axis]),
                        Rgb(extent.y * made.tree.axes(high).v[axis])};
    const std::vector<GatherPoint> points(4000, {low, {0.5, 0.5, 0}});
    constexpr int kAlong = 200;
    double exact = 0;
    for (int k = 0; k < kAlong * kAlong; ++k) {
      const double x = 0.5 + 0.5 * (k % kAlong + 0.5) / kAlong, y = (k / kAlong + 0.5) / kAlong;
      const double r2 = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) + 1;
      exact += 0.5 * (0.5 + x) / (std::numbers::pi * r2 * r2 * kAlong * kAlong);
    }
    for (const double error : {0.01, 0.1, 2.0}) {
      double mean = 0;
      for (const Rgb& H : lit.gather(points, {error, Rgb(1)})) mean += H.r / 4000;
      EXPECT_NEAR(mean, exact, error > 1 ? 0.02 : 0.004) << error;
    }
  }
}

TEST(Gather, OfANearSenderThePartThatIsSeenBringsWhatItShould) {
  // A small face at the middle of a floor, of which a screen leaves it the nearest part.
  constexpr double kScreen = 0.2;
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {{0, -5, 0}, {10, -5, 0}, {10, 5, 0}, {0, 5, 0}});
  by_hand::add(scene, "face", {{0, 0, 0.01}, {0, 0.1, 0.01}, {0, 0.1, 0.1}, {0, 0, 0.1}});
  by_hand::add(scene, "screen", {{kScreen, -9, 0}, {kScreen, -9, 1}, {kScreen, 9, 1}, {kScreen, 9, 0}});
  RefinedTree made(test_scenes::finished(std::move(scene)), 1);
  const NodeId floor = made.tree.face(0, true), face = made.tree.face(1, true);
  made.links = {{floor, face, 0.1F, 0, {}, {}, true}};
  std::vector<Rgb> B;
  for (const NodeId leaf : made.leaves()) B.emplace_back(leaf == floor ? 1 : 0);
  const Lit lit(made, B);
  const glm::dvec3 place{0, 0.05, 0.05};
  const Polygon seen{{0, -5, 0}, {kScreen, -5, 0}, {kScreen, 5, 0}, {0, 5, 0}};
  const double exact = point_to_polygon(place, made.tree[face].shape.normal, seen);
  ASSERT_GT(exact, 0.3);
  const std::vector<GatherPoint> points(16000, {face, place});
  for (const double error : {1e-3, 0.03, 0.1, 2.0}) {
    double mean = 0;
    for (const Rgb& H : lit.gather(points, {error, Rgb(1)})) mean += H.r / 16000;
    EXPECT_NEAR(mean / exact, 1, error > 1 ? 0.05 : 0.02) << error;
  }
}

TEST(Gather, OfASenderThatIsHiddenALittleAsMuchIsSeenWhateverTheRays) {
  // From the middle of one square all of the other is seen but a strip of x < 0.03.
  const std::vector<glm::dvec3> lath{{0.2, -1, 0.5}, {0.265, -1, 0.5}, {0.265, 2, 0.5}, {0.2, 2, 0.5}};
  RefinedTree made(test_scenes::squares_and_wall(lath), 1);
  const NodeId low = made.tree.face(0, true), high = made.tree.face(1, true);
  made.links = {{low, high, 0.1F, 0, {}, {}, true}};
  const Lit lit(made, {Rgb(1), Rgb(1)});
  const glm::dvec3 from(0.5, 0.5, 0);
  const Polygon seen{{0.03, 0, 1}, {0.03, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  const double exact = point_to_polygon(from, {0, 0, 1}, seen);
  const std::vector<GatherPoint> points(4000, {low, from});
  for (const double error : {1e-3, 5e-3, 0.05}) {
    double mean = 0;
    for (const Rgb& H : lit.gather(points, {error, Rgb(1)})) mean += H.r / 4000;
    EXPECT_NEAR(mean / exact, 1, 2e-3) << error;
  }
}

TEST(Gather, AFinerGoalAsksMoreRays) {
  const RefinedTree room(test_scenes::room_with_box(), 3e-3);
  const Lit lit(room, random_light(room, 11));
  const std::vector<GatherPoint> points = points_on(room, 100, 12);
  static_cast<void>(lit.gather(points, {1e-1, Rgb(1)}));
  const std::uint64_t few = lit.rays;
  static_cast<void>(lit.gather(points, {1e-4, Rgb(1)}));
  EXPECT_GT(lit.rays, 2 * few);
}

TEST(Gather, PointsWithoutAFaceAndLightWithoutAny) {
  const RefinedTree room(test_scenes::room_with_box(), 1e-2);
  const Lit dark(room, std::vector<Rgb>(room.leaves().size(), Rgb(0)));
  std::vector<GatherPoint> points = points_on(room, 30, 13);
  points[3] = {};
  for (const Rgb& H : dark.gather(points, {1e-2, Rgb(0)})) EXPECT_EQ(H, Rgb(0));
  const Lit lit(room, random_light(room, 14));
  const std::vector<Rgb> H = lit.gather(points, {1e-2, Rgb(1)});
  EXPECT_EQ(H[3], Rgb(0));
  EXPECT_GT(H[4].g, 0);
}

}  // namespace
}  // namespace fluxel

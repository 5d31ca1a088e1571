#include "hierarchy/face_pair.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "formfactor/view_factor.hpp"
#include "hierarchy/seen_slope.hpp"
#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::TreeOfScene;

constexpr double kEpsilon = 1e-6;

/// Two faces of about a metre, turned at random, so far apart, in front of each other.
Scene far_pair(double distance, std::mt19937& random) {
  for (;;) {
    Scene scene = by_hand::empty_scene(Sides::one);
    const glm::dvec3 away = distance * test_scenes::random_direction(random);
    for (const double side : {0.0, 1.0}) {
      const glm::dvec3 u = test_scenes::random_direction(random);
      const glm::dvec3 v = glm::normalize(glm::cross(u, test_scenes::random_direction(random))) + 0.3 * u;
      if (random() % 2 == 0) {
        by_hand::add(scene, "face", {side * away, side * away + u, side * away + v});
      } else {
        by_hand::add(scene, "face", {side * away, side * away + u, side * away + u + v, side * away + v});
      }
    }
    // Far from the plane of either, so that cosines are no differences of large numbers.
    const glm::dvec3 d = glm::normalize(away);
    if (glm::dot(scene.patches[0].normal, d) > 0.4 && glm::dot(scene.patches[1].normal, d) < -0.4)
      return test_scenes::finished(std::move(scene));
  }
}

/// The exchange area of two faces as if nothing else were there.
double exchange_area(const NodeTree& tree, NodeId p, NodeId q) {
  const FlatShape &of_p = tree[p].shape, &of_q = tree[q].shape;
  const SmallPolygon P = clip_to_front(corners(tree.outline(p)), {of_q.centroid, of_q.normal}, kEpsilon);
  const SmallPolygon Q = clip_to_front(corners(tree.outline(q)), {of_p.centroid, of_p.normal}, kEpsilon);
  if (P.empty() || Q.empty()) return 0;
  return exchange_area_by_contour(corners(P), corners(Q), ContourPoints::fine);
}

TEST(FacePair, TheExchangeOfFarPairs) {
  std::mt19937 random(1);
  for (int k = 0; k < 200; ++k) {
    const double distance = k % 2 == 0 ? 10 : 40;
    const TreeOfScene made(far_pair(distance, random));
    const FacePair pair =
        estimate_face_pair(made.tree, made.tree.face(0, true), made.tree.face(1, true), kEpsilon);
    ASSERT_TRUE(pair.facing);
    EXPECT_FALSE(pair.crossing);
    const double exact = exchange_area(made.tree, made.tree.face(0, true), made.tree.face(1, true));
    EXPECT_NEAR(pair.G, exact, exact * 4 / (distance * distance));
  }
}

TEST(FacePair, SlopesAreThoseOfTheKernel) {
  std::mt19937 random(2);
  for (int k = 0; k < 200; ++k) {
    const TreeOfScene made(far_pair(20, random));
    const NodeTree& tree = made.tree;
    const NodeId p = tree.face(0, true), q = tree.face(1, true);
    const FacePair pair = estimate_face_pair(tree, p, q, kEpsilon);
    const auto kernel = [&](const glm::dvec3& of_p, const glm::dvec3& of_q) {
      const glm::dvec3 d = of_q - of_p;
      const double r2 = glm::dot(d, d);
      return -glm::dot(tree[p].shape.normal, d) * glm::dot(tree[q].shape.normal, d) / (r2 * r2);
    };
    const glm::dvec3 of_p = tree[p].shape.centroid, of_q = tree[q].shape.centroid;
    constexpr double kStep = 1e-4;
    const auto deviation = [&](const glm::dvec3& axis_p, const glm::dvec3& axis_q) {
      const double up = kernel(of_p + kStep * axis_p, of_q + kStep * axis_q),
                   down = kernel(of_p - kStep * axis_p, of_q - kStep * axis_q);
      return (up - down) / (2 * kStep * kernel(of_p, of_q));
    };
    const glm::dvec3 none(0);
    EXPECT_NEAR(pair.p.slope.x, tree[p].extent.x * deviation(tree.axes(p).u, none), 1e-6);
    EXPECT_NEAR(pair.p.slope.y, tree[p].extent.y * deviation(tree.axes(p).v, none), 1e-6);
    EXPECT_NEAR(pair.q.slope.x, tree[q].extent.x * deviation(none, tree.axes(q).u), 1e-6);
    EXPECT_NEAR(pair.q.slope.y, tree[q].extent.y * deviation(none, tree.axes(q).v), 1e-6);
  }
}

TEST(FacePair, ChangeAndBendAreWhatPointsDifferBy) {
  std::mt19937 random(3);
  for (int k = 0; k < 50; ++k) {
    const TreeOfScene made(far_pair(6, random));
    const NodeTree& tree = made.tree;
    const NodeId p = tree.face(0, true), q = tree.face(1, true);
    const FacePair pair = estimate_face_pair(tree, p, q, kEpsilon);
    // Points of p: what they would exchange if all of p were there, about the line that the slope gives.
    constexpr int kAlong = 40;
    double sum = 0, squares = 0, about_line = 0;
    for (int i = 0; i < kAlong * kAlong; ++i) {
      const glm::dvec3 x =
          surface_point(tree.outline(p), (i % kAlong + 0.5) / kAlong, (i / kAlong + 0.5) / kAlong);
      const double G =
          tree[p].shape.area * point_to_polygon(x, tree[p].shape.normal, corners(tree.outline(q)));
      const double line = glm::dot(pair.p.slope, tree.place(p, x));
      sum += G;
      squares += G * G;
      about_line += std::pow(G - pair.G * (1 + line), 2);
    }
    const double mean = sum / (kAlong * kAlong);
    const double deviation = std::sqrt(squares / (kAlong * kAlong) - mean * mean);
    const double residual = std::sqrt(about_line / (kAlong * kAlong));
    EXPECT_GT(pair.p.deviation, 0.6 * deviation);
    EXPECT_LT(pair.p.deviation, 3 * deviation + 0.05 * pair.G);
    EXPECT_GT(pair.p.residual, 0.6 * residual);
  }
}

TEST(FacePair, LongThinFacesThatAreNearEachOther) {
  // Slats of a blind, 2 m x 35 mm, 25 mm apart.
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "low", {{0, 0, 0}, {0.035, 0, 0}, {0.035, 2, 0}, {0, 2, 0}});
  by_hand::add(scene, "high", {{0.02, 0, 0.025}, {0.02, 2, 0.025}, {0.055, 2, 0.025}, {0.055, 0, 0.025}});
  const TreeOfScene made(test_scenes::finished(std::move(scene)));
  const NodeTree& tree = made.tree;
  const NodeId p = tree.face(0, true), q = tree.face(1, true);
  const FacePair pair = estimate_face_pair(tree, p, q, kEpsilon);
  const double exact = exchange_area(tree, p, q);
  EXPECT_NEAR(pair.G, exact, 0.05 * exact);
  // The light changes across their short sides: there they are to be halved.
  EXPECT_NE(pair.p.edge, tree.longest_edge(p));
  EXPECT_NE(pair.q.edge, tree.longest_edge(q));
  EXPECT_GT(pair.p.deviation, 0.2 * exact);
  EXPECT_LT(pair.p.residual, 0.5 * pair.p.deviation) << "most of it is a slope";
}

TEST(FacePair, ASmallFaceCloseToALargeOneIsNotMissed) {
  // The underside of a box that hovers between the places where the floor is sampled.
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}});
  by_hand::add(scene, "underside", {{1.1, 1.1, 0.01}, {1.1, 1.4, 0.01}, {1.4, 1.4, 0.01}, {1.4, 1.1, 0.01}});
  const TreeOfScene made(test_scenes::finished(std::move(scene)));
  const NodeId floor = made.tree.face(0, true), underside = made.tree.face(1, true);
  const FacePair pair = estimate_face_pair(made.tree, floor, underside, kEpsilon);
  const double exact = exchange_area(made.tree, floor, underside);
  EXPECT_NEAR(pair.G, exact, 0.05 * exact);
  EXPECT_GT(pair.p.deviation, 0.9 * exact);
  EXPECT_GT(pair.p.residual, 0.9 * exact);
}

TEST(FacePair, SeenFromTheOtherSideItIsTheSame) {
  const TreeOfScene made(test_scenes::random_plates(30, 0.6, Sides::two, 4));
  const NodeTree& tree = made.tree;
  std::size_t crossing = 0;
  for (std::size_t a = tree.clusters(); a < tree.size(); ++a) {
    for (std::size_t b = a + 1; b < tree.size(); ++b) {
      const auto p = static_cast<NodeId>(a), q = static_cast<NodeId>(b);
      const FacePair pair = estimate_face_pair(tree, p, q, kEpsilon),
                     other = estimate_face_pair(tree, q, p, kEpsilon);
      EXPECT_EQ(pair.facing, other.facing);
      EXPECT_EQ(pair.crossing, other.crossing);
      EXPECT_NEAR(pair.G, other.G, 1e-14);
      for (const auto& [one, same] : {std::pair(pair.p, other.q), std::pair(pair.q, other.p)}) {
        EXPECT_NEAR(glm::distance(one.slope, same.slope), 0, 1e-12);
        EXPECT_NEAR(one.deviation, same.deviation, 1e-12);
        EXPECT_NEAR(one.residual, same.residual, 1e-12);
      }
      // No pair of points gets less than nothing; no face more than its own area.
      EXPECT_LE(steepness(tree, p, pair.p.slope), 1 + 1e-12);
      EXPECT_LE(steepness(tree, q, pair.q.slope), 1 + 1e-12);
      EXPECT_LE(pair.G, std::min(tree[p].shape.area, tree[q].shape.area));
      crossing += pair.crossing ? 1 : 0;
    }
  }
  EXPECT_GT(crossing, 100U);
}

TEST(FacePair, FacingAndCrossing) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "ceiling", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  by_hand::add(scene, "more floor", {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  by_hand::add(scene, "wall", {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}});
  by_hand::add(scene, "plate", {{0.5, 0, -1}, {0.5, 0, 1}, {0.5, 1, 1}, {0.5, 1, -1}});
  by_hand::add(scene, "roof", {{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}});
  const TreeOfScene made(test_scenes::finished(std::move(scene)));
  const auto look = [&](std::size_t a, std::size_t b) {
    return estimate_face_pair(made.tree, made.tree.face(a, true), made.tree.face(b, true), kEpsilon);
  };
  EXPECT_TRUE(look(0, 1).facing);
  EXPECT_FALSE(look(0, 1).crossing);
  EXPECT_FALSE(look(0, 2).facing);  // in one plane
  EXPECT_TRUE(look(0, 3).facing);   // with an edge in common
  EXPECT_FALSE(look(0, 3).crossing);
  EXPECT_TRUE(look(0, 4).facing);  // the plate stands through the floor
  EXPECT_TRUE(look(0, 4).crossing);
  EXPECT_FALSE(look(5, 1).facing);  // the roof looks up
  EXPECT_GT(look(0, 3).G, 0);
  EXPECT_EQ(look(0, 2).G, 0);
}

TEST(FacePair, NothingThatExchangesLightIsPassedOver) {
  std::size_t passed_over = 0, facing = 0;
  for (const unsigned seed : {5U, 6U, 7U}) {
    const TreeOfScene made(test_scenes::random_plates(24, 0.3, Sides::one, seed));
    const NodeTree& tree = made.tree;
    std::vector<std::vector<NodeId>> faces(tree.size());
    for (const NodeId leaf : made.leaves())
      for (NodeId id = leaf; id != kNoNode; id = tree[id].parent) faces[id].push_back(leaf);
    for (NodeId p = 0; p < tree.clusters(); ++p) {
      for (NodeId q = 0; q < tree.size(); ++q) {
        if (test_scenes::is_within(tree, q, p) || test_scenes::is_within(tree, p, q)) continue;
        const bool found = may_face(tree, p, q, kEpsilon);
        EXPECT_EQ(found, may_face(tree, q, p, kEpsilon));
        bool any = false;
        for (const NodeId a : faces[p])
          for (const NodeId b : faces[q]) any = any || estimate_face_pair(tree, a, b, kEpsilon).facing;
        facing += any ? 1 : 0;
        passed_over += found ? 0 : 1;
        EXPECT_TRUE(found || !any) << p << " " << q;
      }
    }
  }
  EXPECT_GT(passed_over, 200U);
  EXPECT_GT(facing, 1000U);
}

TEST(FacePair, ClustersExchangeNoMoreThanTheLargest) {
  std::size_t asked = 0;
  for (const unsigned seed : {8U, 9U}) {
    const TreeOfScene made(test_scenes::random_plates(24, 0.2, Sides::two, seed));
    const NodeTree& tree = made.tree;
    std::vector<std::vector<NodeId>> faces(tree.size());
    for (const NodeId leaf : made.leaves())
      for (NodeId id = leaf; id != kNoNode; id = tree[id].parent) faces[id].push_back(leaf);
    for (NodeId p = 0; p < tree.clusters(); ++p) {
      for (NodeId q = 0; q < tree.size(); ++q) {
        if (test_scenes::is_within(tree, q, p) || test_scenes::is_within(tree, p, q)) continue;
        const double largest = largest_exchange(tree, p, q);
        EXPECT_LE(largest, std::min(tree[p].shape.area, tree[q].shape.area));
        constexpr double kNear = 1.1;
        if (glm::distance(tree[p].shape.centroid, tree[q].shape.centroid) <=
            kNear * (tree[p].radius + tree[q].radius))
          continue;
        ++asked;
        double sum = 0;
        for (const NodeId a : faces[p])
          for (const NodeId b : faces[q]) sum += exchange_area(tree, a, b);
        EXPECT_LE(sum, 1.5 * largest + 1e-12) << p << " " << q;
        EXPECT_EQ(largest, largest_exchange(tree, q, p));
      }
    }
  }
  EXPECT_GT(asked, 1000U);
}

}  // namespace
}  // namespace fluxel

#include "hierarchy/cluster_builder.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

std::vector<Node> random_faces(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Node> faces(count);
  for (Node& face : faces) {
    face.shape.centroid = test_scenes::uniform_point(random, -1, 1);
    face.shape.normal = test_scenes::random_direction(random);
    face.shape.area = test_scenes::uniform(random, 0.001, 0.1);
    face.radius = std::sqrt(face.shape.area);
  }
  return faces;
}

/// All faces below a cluster.
void collect(const ClusterTree& tree, std::uint32_t cluster, std::vector<std::uint32_t>& faces) {
  for (const std::uint32_t child : tree.clusters[cluster].child) {
    if ((child & ClusterTree::kFace) != 0) {
      faces.push_back(child - ClusterTree::kFace);
    } else {
      EXPECT_GT(child, cluster);
      collect(tree, child, faces);
    }
  }
}

/// acos rounds by about the root of the last place.
constexpr double kAngleRounding = 1e-7;

void expect_whole_tree(const std::vector<Node>& faces) {
  const ClusterTree tree = build_cluster_tree(faces, 2);
  ASSERT_EQ(tree.clusters.size(), faces.size() - 1);
  for (std::uint32_t k = 0; k < tree.clusters.size(); ++k) {
    std::vector<std::uint32_t> below;
    collect(tree, k, below);
    const Cone& cone = tree.clusters[k].cone;
    EXPECT_NEAR(glm::length(cone.axis), 1, 1e-12);
    for (const std::uint32_t face : below) {
      const double cosine = glm::dot(cone.axis, faces[face].shape.normal);
      EXPECT_LE(std::acos(std::clamp(cosine, -1.0, 1.0)), cone.half_angle + kAngleRounding);
    }
    if (k != 0) continue;
    std::ranges::sort(below);
    for (std::uint32_t face = 0; face < faces.size(); ++face) ASSERT_EQ(below.at(face), face);
    EXPECT_EQ(below.size(), faces.size());
  }
}

TEST(ClusterBuilder, HoldsEveryFaceOnceAndItsNormal) {
  for (const std::size_t count : {2U, 3U, 17U, 300U}) expect_whole_tree(random_faces(count, 4));
}

TEST(ClusterBuilder, NoTreeOverFewerThanTwoFaces) {
  EXPECT_TRUE(build_cluster_tree({}, 2).clusters.empty());
  EXPECT_TRUE(build_cluster_tree(random_faces(1, 4), 2).clusters.empty());
}

TEST(ClusterBuilder, FacesAtOnePlace) {
  std::vector<Node> faces = random_faces(9, 5);
  for (Node& face : faces) face.shape.centroid = {0.1, 0.2, 0.3};
  expect_whole_tree(faces);
  for (Node& face : faces) face = faces[0];
  expect_whole_tree(faces);
}

TEST(ClusterBuilder, FacesOnALineAndVeryFarApart) {
  std::vector<Node> faces = random_faces(40, 6);
  for (std::size_t k = 0; k < faces.size(); ++k)
    faces[k].shape.centroid = {std::ldexp(1.0, static_cast<int>(k)), 0, 0};
  expect_whole_tree(faces);
}

TEST(ClusterBuilder, IsTheSameForEveryNumberOfThreads) {
  const std::vector<Node> faces = random_faces(20'000, 10);  // enough for halves to be built at once
  const ClusterTree alone = build_cluster_tree(faces, 1), together = build_cluster_tree(faces, 4);
  ASSERT_EQ(alone.clusters.size(), together.clusters.size());
  for (std::size_t k = 0; k < alone.clusters.size(); ++k) {
    const ClusterTree::Cluster &a = alone.clusters[k], &b = together.clusters[k];
    ASSERT_TRUE(std::ranges::equal(a.child, b.child)) << k;
    ASSERT_EQ(a.cone.axis, b.cone.axis);
    ASSERT_EQ(a.cone.half_angle, b.cone.half_angle);
  }
}

TEST(ClusterBuilder, ParallelFacesHaveACone) {
  std::vector<Node> faces = random_faces(20, 7);
  for (Node& face : faces) face.shape.normal = glm::normalize(glm::dvec3(1, 2, 3));
  for (const ClusterTree::Cluster& cluster : build_cluster_tree(faces, 2).clusters)
    EXPECT_LE(cluster.cone.half_angle, kAngleRounding);
}

/// The even ones and the odd ones.
void expect_parted_at_the_root(const std::vector<Node>& faces) {
  const ClusterTree tree = build_cluster_tree(faces, 2);
  for (const std::uint32_t half : tree.clusters[0].child) {
    std::vector<std::uint32_t> below;
    collect(tree, half, below);
    ASSERT_EQ(below.size(), faces.size() / 2);
    for (const std::uint32_t face : below) EXPECT_EQ(face % 2, below[0] % 2);
  }
}

TEST(ClusterBuilder, HeapsThatAreFarApartAreParted) {
  std::vector<Node> faces = random_faces(40, 8);
  for (std::size_t k = 0; k < faces.size(); ++k)
    if (k % 2 == 0) faces[k].shape.centroid.y += 20;
  expect_parted_at_the_root(faces);
}

TEST(ClusterBuilder, FrontsAndBacksArePartedWhereverTheyLie) {
  std::vector<Node> faces = random_faces(40, 8);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    faces[k].shape.centroid.y += k < 20 ? 20 : 0;
    faces[k].front = k % 2 == 0;
  }
  expect_whole_tree(faces);
  expect_parted_at_the_root(faces);
}

TEST(Cones, OfTwoHoldsBothAndIsNoWiderThanNeeded) {
  std::mt19937 random(9);
  for (int k = 0; k < 1000; ++k) {
    const Cone a{test_scenes::random_direction(random), test_scenes::uniform(random, 0, 1)};
    const Cone b{test_scenes::random_direction(random), test_scenes::uniform(random, 0, 1)};
    const Cone both = unite(a, b);
    const auto between = [](const Cone& x, const Cone& y) {
      return std::acos(std::clamp(glm::dot(x.axis, y.axis), -1.0, 1.0));
    };
    EXPECT_NEAR(glm::length(both.axis), 1, 1e-12);
    if (both.half_angle < std::numbers::pi) {
      EXPECT_LE(between(a, both) + a.half_angle, both.half_angle + kAngleRounding);
      EXPECT_LE(between(b, both) + b.half_angle, both.half_angle + kAngleRounding);
    }
    const double needed =
        std::max({a.half_angle, b.half_angle, 0.5 * (a.half_angle + between(a, b) + b.half_angle)});
    EXPECT_NEAR(both.half_angle, std::min(std::numbers::pi, needed), 1e-12);
  }
}

TEST(Cones, OppositeOnesAreAllDirections) {
  const glm::dvec3 up(0, 0, 1);
  EXPECT_EQ(unite({up, 0}, {-up, 0}).half_angle, std::numbers::pi);
  EXPECT_EQ(unite({up, 2}, {-up, 2}).half_angle, std::numbers::pi);
}

}  // namespace
}  // namespace fluxel

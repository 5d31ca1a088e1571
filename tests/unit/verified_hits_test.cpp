#include "hierarchy/verified_hits.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/sampling.hpp"
#include "hierarchy/ray_gather.hpp"
#include "tests/device_followers.hpp"
#include "tests/unit/test_scenes.hpp"
#include "visibility/device_scene.hpp"

namespace fluxel {
namespace {

/// Light that varies over surfaces; of parts so large that where a ray is short it goes on.
class Varying final : public SolutionLight {
 public:
  explicit Varying(const NodeTree& tree) : tree_(tree) {}

  [[nodiscard]] EndLight at(NodeId leaf, const glm::dvec3& point) const override {
    return {tree_.material(leaf).rho * (1.5 + std::sin(9 * point.x) * std::cos(7 * point.y)), 0.004};
  }

 private:
  const NodeTree& tree_;
};

/// A scene, and points of all its faces.
struct Gathered {
  explicit Gathered(const char* name) : scene(test_scenes::load(name, 8, 8).scene) {
    for (std::uint32_t k = 0; k < 5000; ++k) {
      const auto& pieces = scene.pieces;
      const Piece& piece = pieces[(std::size_t{k} * 2654435761u >> 7) % pieces.size()];
      const double u = 0x1p-64 * static_cast<double>(random_bits(k));
      const NodeId face = tree.face(static_cast<std::size_t>(&piece - pieces.data()), true);
      points.push_back({k % 50 == 0 ? kNoNode : face, surface_point(piece.outline, u, 0.3), 1});
    }
  }

  Scene scene;
  RayScene ray_scene{scene, 1};
  NodeTree tree{scene};
  RayLight emitted{ray_scene, tree};
  Varying light{tree};
  std::vector<GatherPoint> points;

  [[nodiscard]] VerifiedHits device(std::size_t calls, bool faulty, double verified) const {
    cuda::SceneArrays arrays = device_scene(ray_scene, {});
    std::vector<PatchId> patches = patches_of(arrays);
    return {std::make_unique<TestHits>(std::move(arrays), calls, faulty), std::move(patches), ray_scene,
            verified};
  }

  struct Found {
    std::array<std::vector<Rgb>, 2> halves;
    std::uint64_t rays;
  };
  [[nodiscard]] Found gather(VerifiedHits* device, LightFrom from) const {
    RayGather gather(emitted, light, Rgb(1, 0.9, 0.8), device);
    const Ranks ranks;
    SilentProgress progress;
    const GatherGoal goal{0.05, Rgb(1), 7, from};
    return {gather.gather(points, goal, {ranks, 2, [] { return false; }, [] {}}, progress), gather.rays()};
  }
};

constexpr std::size_t kForEver = TestFollower::kForEver;

TEST(VerifiedHits, GatherTheSameLightToTheBit) {
  for (const char* name : {"cornell-box", "office-2391"})
    for (const LightFrom from : {LightFrom::everywhere, LightFrom::reflection, LightFrom::emission}) {
      SCOPED_TRACE(name);
      const Gathered of(name);
      VerifiedHits device = of.device(kForEver, false, 0.1);
      const auto expected = of.gather(nullptr, from), found = of.gather(&device, from);
      EXPECT_EQ(found.halves, expected.halves);
      EXPECT_EQ(found.rays, expected.rays);
      if (from == LightFrom::emission) continue;
      const VerifiedCounts& counts = device.counts();
      EXPECT_GT(counts.made, 2 * 12 * 4800u) << "more than the first ones of each point";
      EXPECT_NEAR(static_cast<double>(counts.verified) / static_cast<double>(counts.made), 0.1, 0.02);
      EXPECT_EQ(counts.differing, 0u);
    }
}

TEST(VerifiedHits, WhatIsWrongIsCounted) {
  const Gathered of("cornell-box");
  VerifiedHits device = of.device(kForEver, true, 1);
  static_cast<void>(of.gather(&device, LightFrom::everywhere));
  const VerifiedCounts& counts = device.counts();
  EXPECT_EQ(counts.verified, counts.made);
  EXPECT_GT(counts.differing, counts.made / 4);
  EXPECT_TRUE(differs_too_often(counts, kMostDifferingHits));
}

TEST(VerifiedHits, WhereTheDeviceFailsTheProcessorGoesOn) {
  const Gathered of("cornell-box");
  VerifiedHits device = of.device(3, false, 0);
  EXPECT_EQ(of.gather(&device, LightFrom::everywhere).halves,
            of.gather(nullptr, LightFrom::everywhere).halves);
  EXPECT_EQ(device.failure(), "the GPU could not find hits: planted");
  EXPECT_GT(device.counts().made, 0u);
  EXPECT_LE(device.counts().made, 3 * 1000u + 3 * 8192u);
}

}  // namespace
}  // namespace fluxel

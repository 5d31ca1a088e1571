#include "hierarchy/link_hierarchy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "tests/unit/hierarchy_rounds.hpp"
#include "tests/unit/link_hash.hpp"
#include "tests/unit/refined_tree.hpp"
#include "tests/unit/virtual_ranks.hpp"

namespace fluxel {
namespace {

using test_scenes::add_round;
using test_scenes::centroids;
using test_scenes::hash_of;
using test_scenes::VirtualRanks;

constexpr StopRule kStop{1e-6, 200};

/// All that has to be the same for every number of ranks.
struct Outcome {
  std::size_t nodes = 0;
  std::uint64_t links = 0, of_clusters = 0, links_hash = 0;
  std::vector<Rgb> B, gathered;

  bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(const Ranks& ranks, Hierarchy& hierarchy) {
  SilentProgress silent;
  const NodeTree& tree = hierarchy.tree();
  Outcome outcome{tree.size(), hierarchy.links(), 0, 0, hierarchy.radiosity_of_nodes(), {}};
  std::array<std::uint64_t, 2> sums{0, hash_of(hierarchy.own_links())};
  for (const Link& link : hierarchy.own_links())
    sums[0] += tree.is_cluster(link.p) || tree.is_cluster(link.q) ? 1 : 0;
  ranks.sum(sums);
  outcome.of_clusters = sums[0], outcome.links_hash = sums[1];
  outcome.gathered = hierarchy.gather(centroids(tree), {5e-3, hierarchy.mean_radiosity()}, silent);
  return outcome;
}

/// Of two rounds with importance, as each rank has it.
std::vector<Outcome> outcomes(const RayScene& ray_scene, std::size_t count) {
  std::vector<Outcome> of_ranks(count);
  VirtualRanks::run(count, [&](const Ranks& ranks) {
    LinkHierarchy hierarchy(ranks, ray_scene.scene(), ray_scene, 1, {});
    hierarchy.set_importance_points(centroids(hierarchy.tree()));
    add_round(hierarchy, 8e-3);
    add_round(hierarchy, 2e-3);
    of_ranks[ranks.rank] = outcome_of(ranks, hierarchy);
  });
  return of_ranks;
}

/// Scenes with a light: a room with a box in it, and plates of which clusters are made.
std::vector<std::pair<std::string, Scene>> lit_scenes() {
  std::vector<std::pair<std::string, Scene>> scenes{
      {"room", test_scenes::room_with_box()},
      {"plates", test_scenes::random_plates(80, 0.15, Sides::two, 3)}};
  for (auto& [name, scene] : scenes) scene.patches.front().material = by_hand::kLight;
  return scenes;
}

// In a closed box of one reflectance and exitance B = E + rho B everywhere, whatever its shape.
TEST(Hierarchy, AClosedBoxIsAFurnace) {
  const Rgb E(1, 2, 3), rho(0.8, 0.5, 0.2);
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "box", {0, 0, 0}, {3, 2.4, 1.7}, false);
  scene.materials[0].E = E, scene.materials[0].rho = rho;
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  LinkHierarchy hierarchy({}, scene, ray_scene, 2, {});
  add_round(hierarchy, 1e-3);
  add_round(hierarchy, 1e-4);
  EXPECT_TRUE(hierarchy.radiosity().converged);
  const std::vector<Rgb>& B = hierarchy.radiosity_of_nodes();
  for (std::size_t id = hierarchy.tree().clusters(); id < hierarchy.tree().whole(); ++id)
    for (int c = 0; c < kChannels; ++c) {
      const double exact = E[c] / (1 - rho[c]);
      // Form factors leave about the root of the block error times a fiftieth in the sum of a row (see
      // Refinement.TheLinksOfAFaceOfAClosedCubeAddUpToItsArea), which the light passes 1 / (1 - rho) times.
      EXPECT_NEAR(B[id][c], exact, 2e-4 * rho[c] / (1 - rho[c]) * exact + 1e-6) << id << " " << c;
    }
}

// However bright a lamp is beside all else, sums of small contributions lose nothing.
TEST(Hierarchy, TheLightOfATinyLampIsKept) {
  constexpr double kEdge = 1e-6, kPower = 100, kReflectance = 0.5;
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "box", {0, 0, 0}, {4, 3, 5}, false);
  scene.materials[0].rho = Rgb(kReflectance);
  by_hand::add(scene, "lamp",
               {{1, 2.9, 1}, {1 + kEdge, 2.9, 1}, {1 + kEdge, 2.9, 1 + kEdge}, {1, 2.9, 1 + kEdge}});
  scene.patches.back().material = by_hand::kLight;
  scene.materials.back().E = Rgb(kPower / (kEdge * kEdge));
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  LinkHierarchy hierarchy({}, scene, ray_scene, 1, {});
  for (const double error : {1e-2, 1e-3, 1e-4}) add_round(hierarchy, error);
  const NodeTree& tree = hierarchy.tree();
  const std::vector<Rgb> H = hierarchy.irradiance_of_nodes();
  std::vector<GatherPoint> points;
  double absorbed = 0, gathered = 0;
  for (std::size_t id = tree.clusters(); id < tree.size(); ++id) {
    const auto node = static_cast<NodeId>(id);
    if (!tree[node].is_leaf()) continue;
    points.push_back({node, tree[node].shape.centroid});
    absorbed += tree[node].shape.area * (1 - tree.material(node).rho.g) * H[id].g;
  }
  EXPECT_GT(points.size(), 200U);
  // Form factors of these links leave 0.05 %; the irradiance at centroids is not quite the mean over leaves.
  EXPECT_NEAR(absorbed, kPower, 0.002 * kPower);
  SilentProgress silent;
  const std::vector<Rgb> at = hierarchy.gather(points, {1e-3, hierarchy.mean_radiosity()}, silent);
  for (std::size_t k = 0; k < points.size(); ++k)
    gathered += tree[points[k].face].shape.area * (1 - tree.material(points[k].face).rho.g) * at[k].g;
  EXPECT_NEAR(gathered, kPower, 0.01 * kPower);
}

/// A floor under a lamp at one end of it, and a wall that stands on the floor's long side.
Scene floor_and_wall() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 4, 0}, {0, 4, 0}});
  by_hand::add(scene, "wall", {{0, 0, 0}, {0, 4, 0}, {0, 4, 1}, {0, 0, 1}});
  by_hand::add(scene, "lamp", {{0.3, 0, 1}, {0.3, 0.5, 1}, {0.8, 0.5, 1}, {0.8, 0, 1}});
  scene.patches.back().material = by_hand::kLight;
  return test_scenes::finished(std::move(scene));
}

TEST(Hierarchy, WhatIsCloseToAPointSendsWhatItGetsThere) {
  const Scene scene = floor_and_wall();
  const RayScene ray_scene(scene, 1);
  SilentProgress silent;
  const auto near_the_floor = [&](std::initializer_list<double> errors) {
    LinkHierarchy hierarchy({}, scene, ray_scene, 1, {});
    for (const double error : errors) add_round(hierarchy, error);
    std::vector<GatherPoint> points;
    for (const double y : {0.1, 1.0, 2.0, 3.0, 3.9})
      points.push_back({hierarchy.tree().face(1, true), {0, y, 0.02}});
    return hierarchy.gather(points, {1e-4, hierarchy.mean_radiosity()}, silent);
  };
  const std::vector<Rgb> coarse = near_the_floor({1e9}), fine = near_the_floor({1e-2, 1e-4, 1e-5});
  for (std::size_t k = 0; k < fine.size(); ++k) {
    EXPECT_GT(fine[k].g, 0);
    EXPECT_NEAR(coarse[k].g, fine[k].g, 0.03 * fine[0].g) << "at place " << k;
  }
}

/// Two long plates that face each other and a lamp at one end of the gap.
Scene plates_and_lamp() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "low", {{0, 0, 0}, {0.5, 0, 0}, {0.5, 4, 0}, {0, 4, 0}});
  by_hand::add(scene, "high", {{0, 0, 0.5}, {0, 4, 0.5}, {0.5, 4, 0.5}, {0.5, 0, 0.5}});
  by_hand::add(scene, "lamp", {{0, -0.1, 0}, {0, -0.1, 0.5}, {0.5, -0.1, 0.5}, {0.5, -0.1, 0}});
  scene.patches.back().material = by_hand::kLight;
  return test_scenes::finished(std::move(scene));
}

// Light far down the gap comes by several reflections, each from a place on a leaf that is as long as the
// gap.
TEST(Hierarchy, BetweenCloseSurfacesLightIsFollowedOverSeveralBounces) {
  const Scene scene = plates_and_lamp();
  const RayScene ray_scene(scene, 1);
  SilentProgress silent;
  const auto along_the_gap = [&](std::initializer_list<double> errors) {
    LinkHierarchy hierarchy({}, scene, ray_scene, 1, {});
    for (const double error : errors) add_round(hierarchy, error);
    Rgb sum(0);
    constexpr int kPoints = 100;
    std::vector<GatherPoint> points;
    for (int k = 0; k < kPoints; ++k)
      points.push_back({hierarchy.tree().face(0, true), {0.25, 1.5 + 0.01 * k, 0}});
    for (const Rgb& H : hierarchy.gather(points, {1e-4, hierarchy.mean_radiosity()}, silent))
      sum += H / static_cast<double>(kPoints);
    return sum;
  };
  const Rgb coarse = along_the_gap({1e9}), fine = along_the_gap({1e-2, 1e-4, 1e-5});
  EXPECT_GT(fine.g, 0);
  // Beyond four bounces the leaf's own radiosity counts: of the light at most 0.5^5, as all reflect a half.
  EXPECT_NEAR(coarse.g, fine.g, 0.03 * fine.g);
}

// More points than are gathered at once, all the same but for their rays.
TEST(Hierarchy, PlacesCloseToPointsAreTheSameForEveryNumberOfRanks) {
  const Scene scene = plates_and_lamp();
  const RayScene ray_scene(scene, 1);
  const auto gathered = [&](std::size_t count) {
    std::vector<std::vector<Rgb>> of_ranks(count);
    VirtualRanks::run(count, [&](const Ranks& ranks) {
      LinkHierarchy hierarchy(ranks, scene, ray_scene, 1, {});
      add_round(hierarchy, 1e-2);
      const std::vector<GatherPoint> points(9000, {hierarchy.tree().face(0, true), {0.25, 1.5, 0}});
      SilentProgress silent;
      of_ranks[ranks.rank] = hierarchy.gather(points, {3e-2, hierarchy.mean_radiosity()}, silent);
    });
    return of_ranks;
  };
  const std::vector<Rgb> expected = gathered(1).front();
  for (const std::size_t ranks : {2U, 3U})
    for (const std::vector<Rgb>& found : gathered(ranks)) EXPECT_EQ(found, expected) << ranks;
  std::set<double> different;
  for (const Rgb& H : expected) different.insert(H.g);
  EXPECT_GT(different.size(), 8000U);
}

TEST(Hierarchy, IsTheSameForEveryNumberOfRanks) {
  for (const auto& [name, scene] : lit_scenes()) {
    SCOPED_TRACE(name);
    const RayScene ray_scene(scene, 1);
    const Outcome expected = outcomes(ray_scene, 1).front();
    EXPECT_GT(expected.links, 500U);
    EXPECT_GT(expected.nodes, 60U);
    if (name == "plates") {
      EXPECT_GT(expected.of_clusters, 50U);
    }
    EXPECT_TRUE(std::ranges::any_of(expected.gathered, [](const Rgb& H) { return H.r > 0; }));
    for (const std::size_t ranks : {2U, 3U})
      for (const Outcome& found : outcomes(ray_scene, ranks)) EXPECT_TRUE(found == expected) << ranks;
  }
}

TEST(Hierarchy, ARankWithoutOthersIsWhatRanksAreByDefault) {
  const Scene scene = lit_scenes().front().second;
  const RayScene ray_scene(scene, 1);
  LinkHierarchy hierarchy({}, scene, ray_scene, 1, {});
  hierarchy.set_importance_points(centroids(hierarchy.tree()));
  add_round(hierarchy, 8e-3);
  add_round(hierarchy, 2e-3);
  EXPECT_TRUE(outcome_of({}, hierarchy) == outcomes(ray_scene, 1).front());
}

/// Keeps the most that tree and links of a rank have come to.
class PeakOfBytes final : public Progress {
 public:
  explicit PeakOfBytes(const Hierarchy& hierarchy) : hierarchy_(hierarchy) {}
  void begin(const std::string&, double) override {}
  void update(double, double, const std::string&) override { peak_ = std::max(peak_, hierarchy_.bytes()); }
  void update_error(const ErrorProgress&, const std::string&) override {}
  void end() override {}

  [[nodiscard]] std::uint64_t peak() const { return std::max(peak_, hierarchy_.bytes()); }

 private:
  const Hierarchy& hierarchy_;
  std::uint64_t peak_ = 0;
};

/// Plates that all shine: their pairs, by an error that no cluster keeps to, take several times as much as
/// this.
constexpr std::uint64_t kLittleMemory = std::uint64_t{2} << 20;
Scene many_plates() {
  Scene scene = test_scenes::random_plates(400, 0.05, Sides::two, 11);
  scene.materials[0].E = Rgb(1);
  return scene;
}

TEST(Hierarchy, APassEndsWhereTheMemoryDoes) {
  const Scene scene = many_plates();
  const RayScene ray_scene(scene, 1);
  for (const std::size_t count : {1U, 2U}) {
    SCOPED_TRACE(count);
    VirtualRanks::run(count, [&](const Ranks& ranks) {
      LinkHierarchy hierarchy(ranks, scene, ray_scene, 1, {});
      PeakOfBytes progress(hierarchy);
      EXPECT_FALSE(hierarchy.refine(1e-7, kLittleMemory, progress));
      EXPECT_LT(progress.peak(), kLittleMemory * 11 / 10);
      EXPECT_GT(hierarchy.bytes(), kLittleMemory / 2);
      hierarchy.solve(Solver::conjugate_gradients, kStop, [](const IterationState&) {});
      EXPECT_TRUE(hierarchy.radiosity().converged);
    });
  }
}

TEST(Hierarchy, LaterRoundsEndWhereTheMemoryDoes) {
  const Scene scene = lit_scenes().front().second;
  const RayScene ray_scene(scene, 1);
  LinkHierarchy hierarchy({}, scene, ray_scene, 1, {});
  add_round(hierarchy, 8e-3);
  add_round(hierarchy, 5e-4);
  const std::uint64_t memory = hierarchy.bytes() * 5 / 4;
  PeakOfBytes progress(hierarchy);
  EXPECT_FALSE(hierarchy.refine(1e-7, memory, progress));
  EXPECT_LT(progress.peak(), memory + (std::uint64_t{1} << 17));  // a batch of the fewest pairs
  EXPECT_GT(hierarchy.bytes(), memory * 4 / 5);
}

TEST(Hierarchy, ARefinementThatIsToEndLeavesWhatCanBeSolved) {
  const Scene scene = lit_scenes().front().second;
  const RayScene ray_scene(scene, 1);
  LinkHierarchy whole({}, scene, ray_scene, 1, {});
  add_round(whole, 8e-3);
  const std::uint64_t before = whole.links();
  add_round(whole, 5e-4);
  std::uint64_t of_one = 0;
  for (const std::size_t count : {1U, 2U}) {
    SCOPED_TRACE(count);
    VirtualRanks::run(count, [&](const Ranks& ranks) {
      LinkHierarchy hierarchy(ranks, scene, ray_scene, 1, {});
      add_round(hierarchy, 8e-3);
      // The last rank alone asks for it; the others end with it.
      hierarchy.end_refinement_when([&] { return ranks.rank + 1 == ranks.size; });
      SilentProgress silent;
      EXPECT_FALSE(hierarchy.refine(5e-4, test_scenes::kMuchMemory, silent));
      EXPECT_GE(hierarchy.links(), before);
      EXPECT_LT(hierarchy.links(), whole.links());
      if (count == 1) of_one = hierarchy.links();
      EXPECT_EQ(hierarchy.links(), of_one);
      hierarchy.solve(Solver::conjugate_gradients, kStop, [](const IterationState&) {});
      EXPECT_TRUE(hierarchy.radiosity().converged);
      EXPECT_NEAR(mean_of_colours(hierarchy.mean_radiosity()) / mean_of_colours(whole.mean_radiosity()), 1,
                  0.1);
    });
  }
}

TEST(Hierarchy, WhereTheMemoryEndsThreadsChangeNothing) {
  const Scene scene = many_plates();
  const RayScene ray_scene(scene, 3);
  std::vector<Outcome> of_threads;
  for (const int threads : {1, 2, 3}) {
    SilentProgress silent;
    LinkHierarchy hierarchy({}, scene, ray_scene, threads, {});
    ASSERT_FALSE(hierarchy.refine(1e-7, kLittleMemory, silent));
    hierarchy.solve(Solver::conjugate_gradients, kStop, [](const IterationState&) {});
    of_threads.push_back(outcome_of({}, hierarchy));
  }
  EXPECT_TRUE(of_threads[1] == of_threads[0]);
  EXPECT_TRUE(of_threads[2] == of_threads[0]);
}

TEST(Hierarchy, MemoryThatSufficesChangesNothing) {
  for (const auto& [name, scene] : lit_scenes()) {
    SCOPED_TRACE(name);
    const RayScene ray_scene(scene, 1);
    LinkHierarchy much({}, scene, ray_scene, 1, {});
    add_round(much, 2e-3);
    for (const double factor : {1.3, 2.0, 10.0}) {
      SilentProgress silent;
      LinkHierarchy less({}, scene, ray_scene, 1, {});
      ASSERT_TRUE(
          less.refine(2e-3, static_cast<std::uint64_t>(factor * static_cast<double>(much.bytes())), silent));
      less.solve(Solver::conjugate_gradients, kStop, [](const IterationState&) {});
      EXPECT_TRUE(outcome_of({}, less) == outcome_of({}, much)) << factor;
    }
  }
}

TEST(Hierarchy, AnotherTreeThanTheKeptOneIsAnInputError) {
  const Scene scene = test_scenes::unit_cube();
  const RayScene ray_scene(scene, 1);
  LinkHierarchy hierarchy({}, scene, ray_scene, 1, {});
  KeptRounds kept;
  kept.rounds.emplace_back().nodes = hierarchy.tree().size();
  kept.halvings = {{0, 0}};  // a cluster
  EXPECT_THROW(hierarchy.restore(kept, {}, {}), InputError);
}

}  // namespace
}  // namespace fluxel

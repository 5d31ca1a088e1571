#include "hierarchy/hierarchy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "tests/unit/refined_tree.hpp"
#include "tests/unit/virtual_ranks.hpp"

namespace fluxel {
namespace {

using test_scenes::VirtualRanks;

constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 40;
constexpr StopRule kStop{1e-6, 200};

void add_round(Hierarchy& hierarchy, double error) {
  SilentProgress silent;
  ASSERT_TRUE(hierarchy.refine(error, kMuchMemory, silent));
  hierarchy.solve(Solver::conjugate_gradients, kStop, [](const IterationState&) {});
}

/// The centroids of all faces of whole pieces.
std::vector<GatherPoint> centroids(const NodeTree& tree) {
  std::vector<GatherPoint> points;
  for (std::size_t id = tree.clusters(); id < tree.whole(); ++id)
    points.push_back({static_cast<NodeId>(id), tree[static_cast<NodeId>(id)].shape.centroid});
  return points;
}

/// Of blocks in any order: a sum of what each says.
std::uint64_t hash_of(std::span<const Block> blocks) {
  std::uint64_t sum = 0;
  for (const Block& b : blocks) {
    const std::array<float, 2> values{b.G, b.doubt};
    const std::array<NodeId, 3> whole{b.p, b.q, b.partial ? 1u : 0u};
    const std::array<std::int8_t, 4> slopes{b.over_p.u, b.over_p.v, b.over_q.u, b.over_q.v};
    std::uint64_t hash = hash_bytes(std::as_bytes(std::span(values)));
    hash = hash_bytes(std::as_bytes(std::span(whole)), hash);
    sum += hash_bytes(std::as_bytes(std::span(slopes)), hash);
  }
  return sum;
}

/// All that has to be the same for every number of ranks.
struct Outcome {
  std::size_t nodes = 0;
  std::uint64_t blocks = 0, of_clusters = 0, blocks_hash = 0;
  std::vector<Rgb> B, gathered;

  bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(const Ranks& ranks, Hierarchy& hierarchy) {
  SilentProgress silent;
  const NodeTree& tree = hierarchy.tree();
  Outcome outcome{tree.size(), hierarchy.blocks(), 0, 0, hierarchy.radiosity_of_nodes(), {}};
  std::array<std::uint64_t, 2> sums{0, hash_of(hierarchy.own_blocks())};
  for (const Block& block : hierarchy.own_blocks())
    sums[0] += tree.is_cluster(block.p) || tree.is_cluster(block.q) ? 1 : 0;
  ranks.sum(sums);
  outcome.of_clusters = sums[0], outcome.blocks_hash = sums[1];
  outcome.gathered = hierarchy.gather(centroids(tree), {5e-3, hierarchy.mean_radiosity()}, silent);
  return outcome;
}

/// Of two rounds with importance, as each rank has it.
std::vector<Outcome> outcomes(const RayScene& ray_scene, std::size_t count) {
  std::vector<Outcome> of_ranks(count);
  VirtualRanks::run(count, [&](const Ranks& ranks) {
    Hierarchy hierarchy(ranks, ray_scene.scene(), ray_scene, 1, {});
    hierarchy.look_at_points(centroids(hierarchy.tree()));
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
  Hierarchy hierarchy({}, scene, ray_scene, 2, {});
  add_round(hierarchy, 1e-3);
  add_round(hierarchy, 1e-4);
  EXPECT_TRUE(hierarchy.radiosity().converged);
  const std::vector<Rgb>& B = hierarchy.radiosity_of_nodes();
  for (std::size_t id = hierarchy.tree().clusters(); id < hierarchy.tree().whole(); ++id)
    for (int c = 0; c < kChannels; ++c) {
      const double exact = E[c] / (1 - rho[c]);
      // Form factors leave about the root of the block error times a fiftieth in the sum of a row (see
      // Refinement.TheBlocksOfAFaceOfAClosedCubeAddUpToItsArea), which the light passes 1 / (1 - rho) times.
      EXPECT_NEAR(B[id][c], exact, 2e-4 * rho[c] / (1 - rho[c]) * exact + 1e-6) << id << " " << c;
    }
}

TEST(Hierarchy, IsTheSameForEveryNumberOfRanks) {
  for (const auto& [name, scene] : lit_scenes()) {
    SCOPED_TRACE(name);
    const RayScene ray_scene(scene, 1);
    const Outcome expected = outcomes(ray_scene, 1).front();
    EXPECT_GT(expected.blocks, 500U);
    EXPECT_GT(expected.nodes, 60U);
    if (name == "plates") {
      EXPECT_GT(expected.of_clusters, 50U);
    }
    EXPECT_TRUE(std::ranges::any_of(expected.gathered, [](const Rgb& H) { return H.r > 0; }));
    for (const std::size_t ranks : {2, 3})
      for (const Outcome& found : outcomes(ray_scene, ranks)) EXPECT_TRUE(found == expected) << ranks;
  }
}

TEST(Hierarchy, ARankWithoutOthersIsWhatRanksAreByDefault) {
  const Scene scene = lit_scenes().front().second;
  const RayScene ray_scene(scene, 1);
  Hierarchy hierarchy({}, scene, ray_scene, 1, {});
  hierarchy.look_at_points(centroids(hierarchy.tree()));
  add_round(hierarchy, 8e-3);
  add_round(hierarchy, 2e-3);
  EXPECT_TRUE(outcome_of({}, hierarchy) == outcomes(ray_scene, 1).front());
}

TEST(Hierarchy, AnotherTreeThanTheKeptOneIsAnInputError) {
  const Scene scene = test_scenes::unit_cube();
  const RayScene ray_scene(scene, 1);
  Hierarchy hierarchy({}, scene, ray_scene, 1, {});
  KeptRounds kept;
  kept.rounds.emplace_back().nodes = hierarchy.tree().size();
  kept.halvings = {0};  // a cluster
  EXPECT_THROW(hierarchy.restore(kept, {}, {}), InputError);
}

}  // namespace
}  // namespace fluxel

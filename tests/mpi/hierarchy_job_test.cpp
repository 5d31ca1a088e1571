#include "hierarchy/link_hierarchy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"
#include "small_scenes.hpp"
#include "tests/unit/link_hash.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 40;

/// The centroids of all faces of whole pieces.
std::vector<GatherPoint> centroids(const NodeTree& tree) {
  std::vector<GatherPoint> points;
  for (std::size_t piece = 0; piece < tree.scene().pieces.size(); ++piece)
    for (const bool front : {true, false})
      if (const NodeId face = tree.face(piece, front); face != kNoNode)
        points.push_back({face, tree[face].shape.centroid});
  return points;
}

/// All that has to be the same, of two rounds.
struct Outcome {
  std::size_t nodes = 0;
  std::uint64_t links = 0, links_hash = 0;
  std::vector<Rgb> B, gathered;

  bool operator==(const Outcome&) const = default;
};

constexpr double kCoarse = 4e-3, kFine = 5e-4;
constexpr StopRule kStop{1e-3, 100};

void add_round(Hierarchy& hierarchy, double error) {
  SilentProgress silent;
  ASSERT_TRUE(hierarchy.refine(error, kMuchMemory, silent));
  hierarchy.solve(Solver::conjugate_gradients, kStop, [](const IterationState&) {});
}

Outcome outcome_of(const Communicator& communicator, Hierarchy& hierarchy) {
  SilentProgress silent;
  Outcome outcome{hierarchy.tree().size(),
                  hierarchy.links(),
                  test_scenes::hash_of(hierarchy.own_links()),
                  hierarchy.radiosity_of_nodes(),
                  {}};
  communicator.all_sum(std::span(&outcome.links_hash, 1));
  outcome.gathered =
      hierarchy.gather(centroids(hierarchy.tree()), {5e-3, hierarchy.mean_radiosity()}, silent);
  return outcome;
}

Outcome two_rounds(const Communicator& communicator, const RayScene& ray_scene, int threads) {
  LinkHierarchy hierarchy(ranks_of(communicator), ray_scene.scene(), ray_scene, threads, {});
  hierarchy.set_importance_points(centroids(hierarchy.tree()));
  add_round(hierarchy, kCoarse);
  add_round(hierarchy, kFine);
  return outcome_of(communicator, hierarchy);
}

// A rank alone says what is right.
TEST(Hierarchy, IsTheSameForAllRanksAndThreads) {
  const Communicator alone = world().split(world().rank()).ordered_by_hosts(0);
  for (const NamedRequest& named : small_requests()) {
    SCOPED_TRACE(named.name);
    const Scene scene = scene_of(named.request);
    const RayScene ray_scene(scene, 2);
    const Outcome expected = two_rounds(alone, ray_scene, 1);
    ASSERT_GT(expected.links, 0u);
    EXPECT_TRUE(std::ranges::any_of(expected.gathered, [](const Rgb& H) { return H.r > 0; }));
    for (const int threads : {1, 3}) {
      SCOPED_TRACE(threads);
      const Outcome found = two_rounds(world(), ray_scene, threads);
      EXPECT_EQ(found.nodes, expected.nodes);
      EXPECT_EQ(found.links, expected.links);
      EXPECT_TRUE(found == expected) << "B, irradiance or blocks differ";
    }
  }
}

// The links of all ranks distributed anew, one by one, stand for what has been refined and solved.
TEST(Hierarchy, GoesOnFromWhatWasKept) {
  for (const NamedRequest& named : small_requests()) {
    SCOPED_TRACE(named.name);
    const Scene scene = scene_of(named.request);
    const RayScene ray_scene(scene, 2);
    LinkHierarchy first(ranks_of(world()), scene, ray_scene, 1, {});
    first.set_importance_points(centroids(first.tree()));
    add_round(first, kCoarse);
    KeptRounds kept;
    kept.rounds.emplace_back().nodes = first.tree().size();
    kept.halvings = first.tree().halvings();
    kept.radiosity = first.radiosity();
    const std::vector<Link> all = world().all_gather(first.own_links());
    std::vector<Link> distributed;
    for (std::size_t k = ranks() - 1 - own_rank(); k < all.size(); k += ranks())
      distributed.push_back(all[k]);

    LinkHierarchy second(ranks_of(world()), scene, ray_scene, 2, {});
    second.set_importance_points(centroids(second.tree()));
    second.restore(kept, distributed, {});
    EXPECT_TRUE(outcome_of(world(), second) == outcome_of(world(), first)) << "before going on";
    add_round(first, kFine);
    add_round(second, kFine);
    EXPECT_TRUE(outcome_of(world(), second) == outcome_of(world(), first)) << "one round later";
  }
}

TEST(Hierarchy, RefusesWhatIsOfAnotherTree) {
  const Scene scene = scene_of(two_squares());
  const RayScene ray_scene(scene, 1);
  LinkHierarchy hierarchy(ranks_of(world()), scene, ray_scene, 1, {});
  KeptRounds kept;
  kept.rounds.emplace_back().nodes = hierarchy.tree().size();
  kept.halvings = {{0, 0}};  // a cluster
  EXPECT_THROW(hierarchy.restore(kept, {}, {}), InputError);
}

}  // namespace
}  // namespace fluxel::test

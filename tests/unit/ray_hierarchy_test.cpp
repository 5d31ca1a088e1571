#include "hierarchy/ray_hierarchy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "hierarchy/link_hierarchy.hpp"
#include "tests/unit/hierarchy_rounds.hpp"
#include "tests/unit/test_scenes.hpp"
#include "tests/unit/virtual_ranks.hpp"

namespace fluxel {
namespace {

using test_scenes::add_round;
using test_scenes::centroids;
using test_scenes::VirtualRanks;

void add_ray_round(Hierarchy& hierarchy, double error) { add_round(hierarchy, error, Solver::jacobi); }

/// A room of 4 x 3 x 2.5 m with a lamp below its ceiling and a box with plates around it.
Scene cluttered_room() {
  Scene scene = test_scenes::random_plates(120, 0.15, Sides::two, 5);
  scene.pieces.clear();
  by_hand::add_box(scene, "room", {-2, -1.5, -1.2}, {2, 1.5, 1.3}, false);
  const PatchId lamp =
      by_hand::add(scene, "lamp", {{-0.3, -0.3, 1.2}, {-0.3, 0.3, 1.2}, {0.3, 0.3, 1.2}, {0.3, -0.3, 1.2}});
  scene.patches[index(lamp)].material = by_hand::kLight;
  return test_scenes::finished(std::move(scene));
}

struct RaysOutcome {
  std::vector<NodeId> cut;
  std::vector<Rgb> B, gathered;

  bool operator==(const RaysOutcome&) const = default;
};

RaysOutcome rays_outcome(const Ranks& ranks, const RayScene& ray_scene, int threads) {
  RayHierarchy hierarchy(ranks, ray_scene.scene(), ray_scene, threads, {});
  hierarchy.set_importance_points(centroids(hierarchy.tree()));
  add_ray_round(hierarchy, 4e-2);
  add_ray_round(hierarchy, 1e-2);
  SilentProgress silent;
  return {{hierarchy.cut().begin(), hierarchy.cut().end()},
          hierarchy.radiosity_of_nodes(),
          hierarchy.gather(centroids(hierarchy.tree()), {5e-2, hierarchy.mean_radiosity()}, silent)};
}

// In a closed box of one reflectance and exitance B = E + rho B everywhere. No ray escapes, so that all but
// the noise of the rays to emitters is exact.
TEST(RayHierarchy, AClosedBoxIsAFurnace) {
  const Rgb E(1, 2, 3), rho(0.8, 0.5, 0.2);
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "box", {0, 0, 0}, {3, 2.4, 1.7}, false);
  scene.materials[0].E = E, scene.materials[0].rho = rho;
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  RayHierarchy hierarchy({}, scene, ray_scene, 2, {});
  add_ray_round(hierarchy, 1e-3);
  for (const double sum : hierarchy.leaf_light().own_row_sums) EXPECT_NEAR(sum, 1, 1e-12);
  const Rgb mean = hierarchy.mean_radiosity();
  for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(mean[c], E[c] / (1 - rho[c]), 0.01 * mean[c]) << c;
}

TEST(RayHierarchy, IsTheSameForEveryNumberOfRanksAndThreads) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 3);
  const RaysOutcome expected = rays_outcome({}, ray_scene, 1);
  EXPECT_GT(expected.cut.size(), 500U);
  EXPECT_TRUE(std::ranges::any_of(expected.gathered, [](const Rgb& H) { return H.r > 0; }));
  EXPECT_TRUE(rays_outcome({}, ray_scene, 3) == expected);
  for (const std::size_t count : {2U, 3U, 7U}) {
    std::vector<RaysOutcome> of_ranks(count);
    VirtualRanks::run(count,
                      [&](const Ranks& ranks) { of_ranks[ranks.rank] = rays_outcome(ranks, ray_scene, 1); });
    for (const RaysOutcome& found : of_ranks) EXPECT_TRUE(found == expected) << count;
  }
}

// Two ways that share no form factor.
TEST(RayHierarchy, SaysWhatLinksSay) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 2);
  RayHierarchy by_rays({}, scene, ray_scene, 2, {});
  LinkHierarchy by_links({}, scene, ray_scene, 2, {});
  for (const double error : {4e-2, 1e-2, 1e-3}) add_ray_round(by_rays, error);
  for (const double error : {1e-2, 1e-3}) add_ray_round(by_links, error);
  // Of all surfaces, and of the places of the room's walls.
  const double mean = by_links.mean_radiosity().g;
  EXPECT_NEAR(by_rays.mean_radiosity().g, mean, 0.01 * mean);
  SilentProgress silent;
  const auto gathered = [&](Hierarchy& hierarchy) {
    std::vector<GatherPoint> points;
    for (const GatherPoint& point : centroids(hierarchy.tree()))
      if (hierarchy.tree()[point.face].shape.area > 1) points.push_back(point);
    return hierarchy.gather(points, {1e-2, hierarchy.mean_radiosity()}, silent);
  };
  const std::vector<Rgb> of_rays = gathered(by_rays), of_links = gathered(by_links);
  ASSERT_EQ(of_rays.size(), of_links.size());
  ASSERT_GE(of_rays.size(), 6U);
  for (std::size_t k = 0; k < of_rays.size(); ++k)
    EXPECT_NEAR(of_rays[k].g, of_links[k].g, 0.05 * of_links[k].g + 0.05 * mean) << k;
}

// What emitters send and what is reflected, each gathered on its own, are all.
TEST(Hierarchies, GatherLightInParts) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 2);
  RayHierarchy by_rays({}, scene, ray_scene, 2, {});
  LinkHierarchy by_links({}, scene, ray_scene, 2, {});
  for (Hierarchy* hierarchy : {static_cast<Hierarchy*>(&by_rays), static_cast<Hierarchy*>(&by_links)}) {
    for (const double error : {4e-2, 1e-2}) add_ray_round(*hierarchy, error);
    hierarchy->scale_reflected(Rgb(1.5));
    std::vector<GatherPoint> points;
    for (const GatherPoint& point : centroids(hierarchy->tree()))
      if (points.size() < 60) points.push_back(point);
    SilentProgress silent;
    const auto gathered = [&](LightFrom from) {
      return hierarchy->gather(points, {4e-3, hierarchy->mean_radiosity(), 3, from}, silent);
    };
    const std::vector<Rgb> all = gathered(LightFrom::everywhere), emitted = gathered(LightFrom::emission),
                           reflected = gathered(LightFrom::reflection);
    Rgb sum(0), sum_of_emitted(0), off(0);
    for (std::size_t k = 0; k < points.size(); ++k) {
      sum += all[k];
      sum_of_emitted += emitted[k];
      const Rgb d = emitted[k] + reflected[k] - all[k];
      off += d * d;
    }
    const auto count = static_cast<double>(points.size());
    EXPECT_LT(std::sqrt(off.g / count), 0.03 * sum.g / count);
    EXPECT_GT(sum_of_emitted.g, 0.1 * sum.g);
    EXPECT_LT(sum_of_emitted.g, 0.9 * sum.g);
  }
}

/// Reflected light that is gathered, in the sum of all faces, grows with the scale; what lamps send, which is
/// what is left at 0, does not. `error`: of the gathering; `tolerance`: over that sum.
void expect_scaled(Hierarchy& hierarchy, double error, double tolerance) {
  SilentProgress silent;
  add_ray_round(hierarchy, 1e-2);
  const auto gathered = [&](const Rgb& scale) {
    hierarchy.scale_reflected(scale);
    Rgb sum(0);
    for (const Rgb& H :
         hierarchy.gather(centroids(hierarchy.tree()), {error, hierarchy.mean_radiosity()}, silent))
      sum += H;
    return sum;
  };
  const Rgb scale(0.5, 1, 2);
  const Rgb all = gathered(Rgb(1)), emitted = gathered(Rgb(0)), scaled = gathered(scale);
  const Rgb expected = emitted + scale * (all - emitted);
  for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(scaled[c], expected[c], tolerance * expected[c]) << c;
  EXPECT_GT(emitted.g, 0.1 * all.g);
  EXPECT_LT(emitted.g, 0.9 * all.g);
}

// As few rays as there can be, whose number does not depend on the light, so that it is linear; with links
// there are places close by that are drawn by their light, whose noise is a hundredth.
TEST(Hierarchy, ScalesReflectedLightThatIsGathered) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 2);
  RayHierarchy by_rays({}, scene, ray_scene, 2, {});
  expect_scaled(by_rays, 1e3, 1e-9);
  LinkHierarchy by_links({}, scene, ray_scene, 2, {});
  expect_scaled(by_links, 1e-3, 2e-2);
}

// Points that see a small part of a lamp, or nearly all of it: pilots that all say the same do not mean that
// there is no noise. It falls as fast as the error that is asked for, here to a quarter, give or take what
// 400 points with rare bright rays leave.
TEST(RayHierarchy, NoiseFallsInPenumbrasToo) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
  by_hand::add(scene, "plate", {{-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}, {1, -1, 1}});
  by_hand::add(scene, "lamp", {{-0.5, -0.5, 3}, {-0.5, 0.5, 3}, {0.5, 0.5, 3}, {0.5, -0.5, 3}},
               by_hand::kLight);
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 2);
  RayHierarchy hierarchy({}, scene, ray_scene, 2, {});
  add_ray_round(hierarchy, 1e-1);
  std::vector<GatherPoint> points;
  for (int k = 0; k < 400; ++k)
    points.push_back({hierarchy.tree().face(0, true), glm::dvec3(-2 + 0.01 * k, 0.1, 0)});
  SilentProgress silent;
  const auto noise = [&](double error) {
    const auto [a, b] = hierarchy.gather_halves(points, {error, hierarchy.mean_radiosity()}, silent);
    double squares = 0;
    for (std::size_t k = 0; k < a.size(); ++k) squares += (a[k].g - b[k].g) * (a[k].g - b[k].g);
    return std::sqrt(squares);
  };
  EXPECT_LT(noise(5e-3), 0.4 * noise(2e-2));
}

TEST(RayHierarchy, TheCutHoldsEveryLeafOnce) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 1);
  RayHierarchy hierarchy({}, scene, ray_scene, 2, {});
  add_ray_round(hierarchy, 4e-2);
  add_ray_round(hierarchy, 5e-3);
  const NodeTree& tree = hierarchy.tree();
  const std::vector<NodeId> cut(hierarchy.cut().begin(), hierarchy.cut().end());
  EXPECT_TRUE(std::ranges::any_of(cut, [&](NodeId id) { return tree.is_cluster(id); }));
  EXPECT_TRUE(std::ranges::any_of(cut, [&](NodeId id) { return id >= tree.whole(); }))
      << "no face was halved";
  const LeafUnknowns leaves(tree);
  for (const NodeId leaf : leaves.nodes()) {
    if (leaf == kNoNode) continue;
    int above = 0;
    for (NodeId id = leaf; id != kNoNode; id = tree[id].parent)
      above += std::ranges::binary_search(cut, id) ? 1 : 0;
    EXPECT_EQ(above, 1) << leaf;
  }
}

TEST(RayHierarchy, ARoundIsTakenUp) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 1);
  RayHierarchy first({}, scene, ray_scene, 1, {});
  first.set_importance_points(centroids(first.tree()));
  add_ray_round(first, 4e-2);
  KeptRounds kept;
  kept.rounds.emplace_back().nodes = first.tree().size();
  kept.halvings = first.tree().halvings();
  kept.cut = {first.cut().begin(), first.cut().end()};
  kept.radiosity = first.radiosity();
  RayHierarchy second({}, scene, ray_scene, 1, {});
  second.set_importance_points(centroids(second.tree()));
  KeptRounds without_a_node = kept;
  without_a_node.cut.pop_back();
  KeptRounds with_a_child = kept;
  const NodeId cluster =
      *std::ranges::find_if(kept.cut, [&](NodeId id) { return first.tree().is_cluster(id); });
  with_a_child.cut.push_back(first.tree()[cluster].child[0]);
  second.restore(kept, {}, first.counts());
  add_ray_round(first, 1e-2);
  add_ray_round(second, 1e-2);
  EXPECT_EQ(std::vector(first.cut().begin(), first.cut().end()),
            std::vector(second.cut().begin(), second.cut().end()));
  EXPECT_EQ(first.radiosity_of_nodes(), second.radiosity_of_nodes());
  RayHierarchy third({}, scene, ray_scene, 1, {});
  EXPECT_THROW(third.restore(without_a_node, {}, first.counts()), InputError);
  RayHierarchy fourth({}, scene, ray_scene, 1, {});
  EXPECT_THROW(fourth.restore(with_a_child, {}, first.counts()), InputError);
}

TEST(RayHierarchy, EndsWhereTheMemoryDoes) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 1);
  RayHierarchy hierarchy({}, scene, ray_scene, 1, {});
  add_ray_round(hierarchy, 4e-2);
  SilentProgress silent;
  const std::uint64_t memory = hierarchy.bytes() * 2;
  EXPECT_FALSE(hierarchy.refine(1e-5, memory, silent));
  EXPECT_LT(hierarchy.bytes(), memory * 11 / 10);
  hierarchy.solve(Solver::jacobi, {1e-6, 2000}, [](const IterationState&) {});
  EXPECT_TRUE(hierarchy.radiosity().converged);
}

TEST(RayHierarchy, EndsWhereItIsAskedTo) {
  const Scene scene = cluttered_room();
  const RayScene ray_scene(scene, 1);
  RayHierarchy hierarchy({}, scene, ray_scene, 1, {});
  add_ray_round(hierarchy, 4e-2);
  const std::size_t before = hierarchy.cut().size();
  hierarchy.end_refinement_when([] { return true; });
  SilentProgress silent;
  EXPECT_FALSE(hierarchy.refine(1e-3, test_scenes::kMuchMemory, silent));
  EXPECT_EQ(hierarchy.cut().size(), before);
  hierarchy.solve(Solver::jacobi, {1e-6, 2000}, [](const IterationState&) {});
  EXPECT_TRUE(hierarchy.radiosity().converged);
}

}  // namespace
}  // namespace fluxel

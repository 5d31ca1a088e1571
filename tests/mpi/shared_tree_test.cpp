#include <gtest/gtest.h>

#include <vector>

#include "hierarchy/emitter_draw.hpp"
#include "hierarchy/node_tree.hpp"
#include "host_shapes.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel::test {
namespace {

/// Of faces so many that the pages of their nodes are shared.
Scene many_plates() {
  Scene scene = test_scenes::random_plates(12'000, 0.02, Sides::two, 4);
  for (std::size_t k = 0; k < scene.patches.size(); k += 100) scene.patches[k].material = by_hand::kLight;
  return scene;
}

/// On each rank others, as one that went its own way would.
void halve_some(NodeTree& tree, std::size_t first) {
  std::vector<Halving> halvings;
  for (std::size_t id = tree.clusters() + first; id < tree.whole(); id += 37)
    if (tree[static_cast<NodeId>(id)].front)
      halvings.push_back({static_cast<NodeId>(id), tree.longest_edge(static_cast<NodeId>(id))});
  tree.split(halvings);
}

void expect_same(const NodeTree& tree, const NodeTree& expected) {
  ASSERT_EQ(tree.size(), expected.size());
  ASSERT_EQ(tree.clusters(), expected.clusters());
  ASSERT_EQ(tree.whole(), expected.whole());
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    const Node &a = tree[id], &b = expected[id];
    bool same = a.shape.centroid == b.shape.centroid && a.shape.normal == b.shape.normal &&
                a.shape.area == b.shape.area && a.radius == b.radius && a.extent == b.extent &&
                a.parent == b.parent && a.child == b.child && a.twin == b.twin && a.piece == b.piece &&
                a.front == b.front && a.halved == b.halved;
    if (tree.is_cluster(id)) {
      same = same && tree.cone(id).axis == expected.cone(id).axis &&
             std::ranges::equal(tree.faces_of_cluster(id), expected.faces_of_cluster(id));
    } else {
      same = same && tree.outline(id).corner == expected.outline(id).corner &&
             tree.leaf_below(id, a.shape.centroid) == expected.leaf_below(id, b.shape.centroid);
    }
    wrong += same ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(SharedTree, IsThatOfOneRankAndEachMaySplitItsOwn) {
  const Scene scene = many_plates();
  const RayScene ray_scene(scene, 1);
  NodeTree alone(scene);
  const EmitterDraw emitters_alone(alone, ray_scene);
  halve_some(alone, own_rank() % 7);
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    NodeTree tree(scene, 1, ranks_of(shape.world));
    const EmitterDraw emitters(tree, ray_scene, 1, ranks_of(shape.world));
    halve_some(tree, own_rank() % 7);
    shape.world.barrier();  // all have written
    expect_same(tree, alone);
    const NodeId face = tree.face(7, true);
    const ReceivingPoint at{tree[face].shape.centroid, tree[face].shape.normal, emitters.region_of(face)};
    EXPECT_EQ(at.region, emitters_alone.region_of(face));
    for (int k = 0; k < 20; ++k) {
      const double choice = (k + 0.5) / 20;
      const DrawnEmitter drawn = emitters.draw(at, choice, 0.3, 0.6);
      const DrawnEmitter expected = emitters_alone.draw(at, choice, 0.3, 0.6);
      EXPECT_EQ(drawn.face, expected.face);
      EXPECT_EQ(drawn.density, expected.density);
    }
    shape.world.barrier();
  }
}

}  // namespace
}  // namespace fluxel::test

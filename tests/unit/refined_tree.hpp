#pragma once

#include <map>
#include <random>
#include <utility>
#include <vector>

#include "core/sampling.hpp"
#include "hierarchy/cluster_shares.hpp"
#include "hierarchy/node_light.hpp"
#include "hierarchy/node_tree.hpp"
#include "hierarchy/refinement.hpp"
#include "tests/unit/test_scenes.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel::test_scenes {

/// A scene with its tree of nodes.
struct TreeOfScene {
  explicit TreeOfScene(Scene of) : scene(std::move(of)), ray_scene(scene, 1), tree(scene) {}

  Scene scene;
  RayScene ray_scene;
  NodeTree tree;

  [[nodiscard]] double epsilon() const { return static_cast<double>(ray_scene.surface_epsilon()); }

  [[nodiscard]] std::vector<NodeId> leaves() const {
    std::vector<NodeId> found;
    for (std::size_t id = tree.clusters(); id < tree.size(); ++id)
      if (tree[static_cast<NodeId>(id)].is_leaf()) found.push_back(static_cast<NodeId>(id));
    return found;
  }

  /// Across the middle of their longest edges.
  void halve(std::span<const NodeId> ids) {
    std::vector<Halving> halvings;
    for (const NodeId id : ids) halvings.push_back({id, tree.longest_edge(id)});
    tree.split(halvings);
  }

  void halve_all(int times) {
    for (; times > 0; --times) halve(leaves());
  }

  /// As a solve begins.
  void share_out() {
    std::vector<NodeId> faces;
    for (std::size_t id = tree.clusters(); id < tree.whole(); ++id) faces.push_back(static_cast<NodeId>(id));
    tree.set_shares(cluster_shares(tree, light_out(ray_scene, tree, faces, 1)));
  }

  /// Halves leaves until there are about so many more, chosen at random.
  void halve_some(int splits, unsigned seed) {
    std::mt19937 random(seed);
    for (; splits > 0; --splits) {
      const std::vector<NodeId> now = leaves();
      halve(std::vector<NodeId>{now[random() % now.size()]});
    }
  }
};

/// The radiosity everywhere 1 and as uneven as light mostly is.
[[nodiscard]] inline std::vector<NodeLight> even_light(const NodeTree& tree) {
  return std::vector<NodeLight>(tree.size(), NodeLight{1, 0.2F, 0.5F, 1});
}

/// Links for even light, and a tree that has the nodes which they asked for.
struct RefinedTree : TreeOfScene {
  RefinedTree(Scene of, double error) : TreeOfScene(std::move(of)), refiner(ray_scene, tree), goal{error, 1} {
    for (std::vector<NodePair> open{{0, 0}}; !open.empty(); open = take_out_poor()) {
      while (!open.empty()) {
        RefinedPairs found;
        for (const NodePair& pair : open) refiner.refine(pair, even_light(tree), goal, found);
        links.insert(links.end(), found.links.begin(), found.links.end());
        std::map<NodeId, std::uint32_t> wanted;
        for (const WantedHalving& one : found.wanted) wanted.emplace(one.halving.leaf, one.halving.edge);
        std::vector<Halving> halvings;
        for (const auto& [leaf, edge] : wanted) halvings.push_back({leaf, edge});
        tree.split(halvings);
        open = std::move(found.open);
      }
    }
  }

  Refiner refiner;
  RefinementGoal goal;
  std::vector<Link> links;

 private:
  /// What was enough between leaves may not be between nodes that have been halved since.
  std::vector<NodePair> take_out_poor() {
    const std::vector<NodeLight> light = even_light(tree);
    std::vector<NodePair> open;
    std::erase_if(links, [&](const Link& link) {
      if (refiner.oracle(light, goal).is_enough(link)) return false;
      open.push_back({link.p, link.q});
      return true;
    });
    return open;
  }
};

/// A room with a box that stands free in it, all of it one-sided.
[[nodiscard]] inline Scene room_with_box() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "room", glm::dvec3(-0.5), glm::dvec3(0.5), false);
  by_hand::add_box(scene, "box", {-0.2, -0.15, -0.3}, {0.15, 0.2, 0.1}, true);
  return finished(std::move(scene));
}

/// Two squares a metre apart that face each other, and half way between a wall that sends nothing, if it has
/// corners.
[[nodiscard]] inline Scene squares_and_wall(const std::vector<glm::dvec3>& wall) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "low", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "high", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  if (!wall.empty()) {
    by_hand::add(scene, "wall", wall);
    scene.patches.back().sides = 0;
  }
  return finished(std::move(scene));
}

/// Walls of that: none, one that hides all, and those that leave the half with the larger x or y open.
inline const std::vector<glm::dvec3> kNoWall,
    kWholeWall{{-1, -1, 0.5}, {2, -1, 0.5}, {2, 2, 0.5}, {-1, 2, 0.5}},
    kWallOfSmallX{{-1, -1, 0.5}, {0.5, -1, 0.5}, {0.5, 2, 0.5}, {-1, 2, 0.5}},
    kWallOfSmallY{{-1, -1, 0.5}, {2, -1, 0.5}, {2, 0.5, 0.5}, {-1, 0.5, 0.5}};

/// A point of a node, which is a face.
[[nodiscard]] inline glm::dvec3 random_point(const NodeTree& tree, NodeId id, std::mt19937& random) {
  const double u = uniform(random, 0, 1);
  return surface_point(tree.outline(id), u, uniform(random, 0, 1));
}

/// Whether `below` is the node or below it.
[[nodiscard]] inline bool is_within(const NodeTree& tree, NodeId below, NodeId id) {
  while (below != kNoNode && below != id) below = tree[below].parent;
  return below == id;
}

}  // namespace fluxel::test_scenes

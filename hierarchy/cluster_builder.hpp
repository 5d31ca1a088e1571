#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// A binary tree over faces, the root first: a cluster, all that its first child holds, all that the second
/// does.
struct ClusterTree {
  struct Cluster {
    std::uint32_t child[2];  ///< a cluster, or kFace + the number of a face
    Cone cone;
    std::uint32_t first, last;  ///< what it holds, in `faces`
  };
  static constexpr std::uint32_t kFace = 0x80000000u;
  std::vector<Cluster> clusters;     ///< none where there are fewer than two faces
  std::vector<std::uint32_t> faces;  ///< numbers, those of each cluster together
};

/// Fronts and backs, if there are both, are the root's halves. All else splits where the sum over both halves
/// of area times extent of box times spread of normals is least, of a few planes across each axis (the
/// surface area orientation heuristic of Conty Estevez & Kulla 2018, with area for power, and the spread from
/// the mean of the normals). The same for every number of threads.
[[nodiscard]] ClusterTree build_cluster_tree(std::span<const Node> faces, int threads);

/// The smallest cone, for the most part, that holds both.
[[nodiscard]] Cone unite(const Cone& a, const Cone& b);

}  // namespace fluxel

#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// How two faces see each other where nothing stands between, in rough numbers; all are exchange areas [m2].
struct FacePair {
  bool facing = false;    ///< some of each lies in front of the other
  bool crossing = false;  ///< one of them crosses the other's plane
  double G = 0;
  /// What is known of the kernel over the points of one of them.
  struct Over {
    /// What it rises by from the centroid to the face's extents, over its mean: of faces that are far from
    /// each other by its gradient at the centroids, of near ones the best linear fit; nowhere below -1.
    glm::dvec2 slope{0};
    double deviation = 0;    ///< standard deviation of what the points exchange with the other face
    double residual = 0;     ///< the same when the slope has been taken off
    std::uint32_t edge = 0;  ///< along which it changes most: the one to halve
  };
  Over p, q;
};

/// Of faces that are far from each other against their sizes, from the kernel cos cos / (pi r^2) between the
/// centroids with its gradients in the planes of both, sizes being those of the second moments. Of others
/// from the configuration factors of some places of each towards the whole of the other. Heights up to
/// `epsilon` [m] above a plane lie in it.
[[nodiscard]] FacePair estimate_face_pair(const NodeTree& tree, NodeId p, NodeId q, double epsilon);

/// Whether anything of the two nodes, of which one is a cluster, may face the other.
[[nodiscard]] bool may_face(const NodeTree& tree, NodeId p, NodeId q, double epsilon);

/// At most about this is the exchange area of the two [m2], of which one is a cluster; a cluster may exchange
/// with itself. Where their spheres nearly touch, two faces may exchange more.
[[nodiscard]] double largest_exchange(const NodeTree& tree, NodeId p, NodeId q);

}  // namespace fluxel

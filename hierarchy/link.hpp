#pragma once

#include <cstdint>

#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// A pair of nodes; of a node with itself, all pairs within it.
struct NodePair {
  NodeId p = kNoNode, q = kNoNode;

  bool operator==(const NodePair&) const = default;
};

/// How the light of a link slopes over one of its faces: what it changes by along each axis from the
/// centroid to the face's extent, in parts of 1 / kSlopeOne of the mean.
struct Slope {
  std::int8_t u = 0, v = 0;
};
inline constexpr double kSlopeOne = 63;
/// Along an axis; so that it fits.
inline constexpr double kSteepest = 2;

/// Light between two nodes, or of a cluster within itself: of two faces G times the product of two linear
/// functions, one over the points of each, neither of which is negative anywhere.
struct Link {
  NodeId p = kNoNode, q = kNoNode;
  float G = 0;        ///< exchange area A_p F_pq = A_q F_qp, what stands between taken off [m2]
  float G_error = 0;  ///< about its largest error [m2]
  /// FacePair::Over::slope; where something stands between, seen_slope.
  Slope over_p, over_q;
  bool partial = false;  ///< something stands between parts of them
};

}  // namespace fluxel

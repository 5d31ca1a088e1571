#pragma once

#include <cstdint>

#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// A pair of nodes; of a node with itself, all pairs within it.
struct NodePair {
  NodeId p = kNoNode, q = kNoNode;

  bool operator==(const NodePair&) const = default;
};

/// How the kernel of a block slopes over one of its faces: FacePair::Over::slope, in parts of kSteepest.
struct Slope {
  std::int8_t u = 0, v = 0;
};
inline constexpr double kSteepest = 127;

/// Light between two nodes, or of a cluster within itself: of two faces the kernel to first order over the
/// points of both.
struct Block {
  NodeId p = kNoNode, q = kNoNode;
  float G = 0;      ///< exchange area A_p F_pq = A_q F_qp, what stands between taken off [m2]
  float doubt = 0;  ///< about its largest error [m2]
  Slope over_p, over_q;
  bool partial = false;  ///< something stands between parts of them
};

}  // namespace fluxel

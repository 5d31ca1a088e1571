#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/cut_light.hpp"
#include "hierarchy/ray_light.hpp"

namespace fluxel {

/// A ray of a node's hemispheres that ends on a leaf.
struct RayEnd {
  NodeId leaf = kNoNode;
  NodeId from = kNoNode;       ///< the face that it starts on
  std::array<float, 2> place;  ///< on the face of the whole piece, see NodeTree::place
  bool second_half = false;    ///< of the node, see RayRow
};

/// A row of F as rays of a node find it (Malley's method; Wallace, Elmquist & Haines 1989 have form factors
/// by rays): each of them stands for an equal part. They start all over the faces of the node, the more the
/// more a place lies open, and are distributed by the cosine, so that of what does not escape nothing is
/// missing. What emitters send is
/// apart. What each of the node's halves receives tells how much light varies over it: the children of a
/// cluster, or of a face what it would be halved into.
struct RayRow {
  NodeId node = kNoNode;
  std::vector<RayEnd> ends;               ///< of rays that end on a leaf
  std::array<std::uint32_t, 2> rays{};    ///< that there were, of each half
  std::array<Rgb, kCubeSides> emitted{};  ///< irradiance by emitters; of a face the first [W/m2]
  /// Sums over the rays of each half of the parts of their normals; of a face the first.
  std::array<std::array<double, kCubeSides>, 2> half_weights{};
  /// Of each half, mean of the colours, and the variance of that mean.
  std::array<double, 2> half_emitted{}, half_variance{};

  [[nodiscard]] double weight(std::size_t side) const {
    return half_weights[0][side] + half_weights[1][side];
  }
};

/// Rays of a node; depends on the arguments alone. May run from many threads at once. Adds the rays to
/// `traced`.
[[nodiscard]] RayRow trace_row(const RayLight& light, NodeId node, const RayNumbers& numbers,
                               std::uint64_t& traced);

/// Puts the end on the leaf that its place lies on, after leaves have been halved.
void descend(const NodeTree& tree, RayEnd& end);

/// The edge across whose middle a face is or would be halved, of the front's outline.
[[nodiscard]] std::uint32_t edge_to_halve(const NodeTree& tree, NodeId face);

/// An estimate of the standard deviation of the irradiance over the node, beyond what its cube tells, by what
/// its halves receive; the noise of the rays is taken off. `reflected`: by what each of the row's rays ends
/// on, mean of the colours [W/m2].
[[nodiscard]] double deviation(const NodeTree& tree, const RayRow& row, std::span<const double> reflected);

}  // namespace fluxel

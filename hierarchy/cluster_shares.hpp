#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/node_tree.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// How much of the light that faces send leaves the clusters above them, by kShareRays cosine-distributed
/// rays from each of `faces`, all whole pieces: kDirections entries for each of tree.whole(), of a cluster's
/// child what leaves the cluster along each, in units of area that are the same for every part of the faces,
/// so that entries can be summed. A ray leaves a cluster where it ends outside of the sphere around it; one
/// that ends on no side that is an unknown carries no light.
[[nodiscard]] std::vector<std::uint64_t> light_out(const RayScene& ray_scene, const NodeTree& tree,
                                                   std::span<const NodeId> faces, int threads);

inline constexpr int kShareRays = 32;

/// Smits, Arvo & Greenberg (1994) spread what a cluster exchanges evenly over its faces. But those that look
/// at other faces of the cluster, or stand on something, have less of it or none, and those that light comes
/// to send it back to where it came from: spread evenly it would be dimmed with every reflection. For
/// NodeTree::set_shares, from the sums over all faces; where nothing leaves along a direction as in all,
/// where nothing leaves at all, and within, by area.
[[nodiscard]] std::vector<WayShares> cluster_shares(const NodeTree& tree,
                                                    std::span<const std::uint64_t> light_out);

}  // namespace fluxel

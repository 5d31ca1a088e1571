#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "hierarchy/hierarchy.hpp"

namespace fluxel::test_scenes {

inline constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 40;

/// Jacobi's iteration takes the more sweeps.
inline void add_round(Hierarchy& hierarchy, double error, Solver solver = Solver::conjugate_gradients) {
  SilentProgress silent;
  ASSERT_TRUE(hierarchy.refine(error, kMuchMemory, silent));
  hierarchy.solve(solver, {1e-6, solver == Solver::jacobi ? 2000 : 200}, [](const IterationState&) {});
}

/// The centroids of all faces of whole pieces.
inline std::vector<GatherPoint> centroids(const NodeTree& tree) {
  std::vector<GatherPoint> points;
  for (std::size_t id = tree.clusters(); id < tree.whole(); ++id)
    points.push_back({static_cast<NodeId>(id), tree[static_cast<NodeId>(id)].shape.centroid});
  return points;
}

}  // namespace fluxel::test_scenes

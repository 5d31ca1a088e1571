#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/audit_paths.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/hierarchy_round.hpp"
#include "hierarchy/node_light.hpp"
#include "hierarchy/node_tree.hpp"
#include "solver/iterate.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// What finished rounds have come to, which with the links of all ranks is all that the next one needs.
struct KeptRounds {
  std::uint64_t ranks = 0;             ///< that have kept the links, each in a file of its own
  std::vector<HierarchyRound> rounds;  ///< one at least
  std::vector<Halving> halvings;       ///< see NodeTree
  std::vector<NodeId> cut;             ///< of a hierarchy by rays; without links
  Radiosity radiosity;  ///< Hierarchy::radiosity of the last round, without its `discretisation`
  AuditPaths paths;     ///< of audits before the last round
};

/// A hash of all that rounds depend on: what the visibility of the scene does (see visibility_identity), the
/// light and reflectances of the tree's unknowns, the points that errors are looked at by, the way this
/// program refines, and `choices`: the numbers that the user or the run has chosen. The tree has not been
/// split. Threads and ranks change nothing in it.
[[nodiscard]] std::uint64_t rounds_identity(const RayScene& ray_scene, const NodeTree& tree,
                                            const Unknowns& unknowns, std::span<const GatherPoint> seen,
                                            std::span<const double> choices);

/// The file that names the last finished round; docs/file-formats.md has the format.
[[nodiscard]] std::string rounds_file(const KeptRounds& kept, std::uint64_t identity);

/// What reading such a file came to.
struct RoundsFileResult {
  std::optional<KeptRounds> kept;
  std::string defect;  ///< why there is none, as the end of a sentence
};

/// Reads the bytes of such a file, wherever they come from. What it gives has numbers that suit each other,
/// but whether the tree can be halved so has to be looked at.
[[nodiscard]] RoundsFileResult read_rounds_file(std::span<const std::byte> bytes, std::uint64_t identity);

}  // namespace fluxel

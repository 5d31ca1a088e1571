#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "scene/scene.hpp"
#include "visibility/box_tree.hpp"
#include "visibility/shaft.hpp"

namespace fluxel {

/// The patches as occluders in double precision, in a hierarchy of boxes, for the question which of them may
/// stand in a shaft. Lists come in the order of the tree, which depends on the scene alone; epsilon [m] is
/// the shaft's. The list of a shaft holds, but for rounding against epsilon, those of every shaft within it,
/// so that the pairs between two clusters can filter the list of the clusters.
class PatchTree {
 public:
  /// The scene must outlive this.
  explicit PatchTree(const Scene& scene);

  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  /// Appends the patches that may meet the shaft; stops where there are more than `most` of them, and then
  /// returns false.
  bool candidates(const Shaft& shaft, double epsilon, std::vector<PatchId>& out,
                  std::size_t most = kAll) const;

  /// The same of those of `among`, in their order.
  bool filter(const Shaft& shaft, double epsilon, std::span<const PatchId> among, std::vector<PatchId>& out,
              std::size_t most = kAll) const;

  /// Calls visit(id) for the patches of all leaves that pass enter(box), as do the nodes above them, until it
  /// returns true; returns whether it did.
  template <class Enter, class Visit>
  bool search(const Enter& enter, const Visit& visit) const;

 private:
  /// A leaf holds ids_[first, first + count); the children of another node are nodes `first` and `first` + 1.
  struct Node {
    Box box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  [[nodiscard]] bool may_meet(const Shaft& shaft, double epsilon, PatchId id) const {
    return shaft.may_meet(patches_[index(id)].outline, epsilon);
  }

  std::span<const Patch> patches_;
  std::vector<PatchId> ids_;
  std::vector<Node> nodes_;  // the root first; none without patches
};

template <class Enter, class Visit>
bool PatchTree::search(const Enter& enter, const Visit& visit) const {
  return search_boxes(
      nodes_, [&](const Node& node) { return enter(node.box); },
      [&](std::uint32_t k) { return visit(ids_[k]); });
}

}  // namespace fluxel

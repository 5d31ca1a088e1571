#pragma once

#include <cstddef>

#include "core/element.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Tells of pairs of elements whose centroids do not see each other whether a single patch hides all of one
/// from all of the other. Neighbours are mostly hidden by the same patch, which is tried first.
class HiddenPairs {
 public:
  /// Both must outlive this.
  HiddenPairs(const RayScene& ray_scene, const ElementView& mesh) : ray_scene_(ray_scene), mesh_(mesh) {}

  /// Forgets the pairs before.
  void restart() { last_ = kNoPatch; }

  /// True only where a patch cuts every segment between i and j (visibility/cuts_off): that of the pair
  /// before, or the first on the way from one centroid to the other.
  [[nodiscard]] bool hidden(std::size_t i, std::size_t j);

 private:
  [[nodiscard]] PatchId first_between(std::size_t from, std::size_t to) const;

  const RayScene& ray_scene_;
  const ElementView& mesh_;
  PatchId last_ = kNoPatch;
};

}  // namespace fluxel

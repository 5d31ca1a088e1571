#include "formfactor/tile_occluders.hpp"

namespace fluxel {

std::optional<std::span<const PatchId>> TileOccluders::candidates(std::size_t i) {
  if (!known_ && !occlusion_.occluders.patches.empty())
    too_many_ =
        !occlusion_.tree.candidates(Shaft(row_, column_), occlusion_.epsilon, of_tiles_, kMostCandidates);
  known_ = true;
  if (too_many_) return std::nullopt;
  if (of_tiles_.empty() || element_ == i) return of_element_;
  const Outline<glm::dvec3> outline = widen(mesh_.outlines[i]);
  of_element_.clear();
  occlusion_.tree.filter(Shaft(bounds(corners(outline)), column_), occlusion_.epsilon, of_tiles_,
                         of_element_);
  element_ = i;
  return of_element_;
}

}  // namespace fluxel

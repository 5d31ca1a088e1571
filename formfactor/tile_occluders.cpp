#include "formfactor/tile_occluders.hpp"

#include <array>

namespace fluxel {

std::span<const PatchId> TileOccluders::candidates(std::size_t i) {
  if (!known_ && !occlusion_.occluders.patches.empty())
    occlusion_.tree.candidates(Shaft(row_, column_), occlusion_.epsilon, of_tiles_);
  known_ = true;
  if (of_tiles_.empty() || element_ == i) return of_element_;
  const Outline<glm::dvec3> outline = widen(mesh_.outlines[i]);
  of_element_.clear();
  occlusion_.tree.filter(Shaft(bounds(corners(outline)), column_), occlusion_.epsilon, of_tiles_,
                         of_element_);
  element_ = i;
  return of_element_;
}

}  // namespace fluxel

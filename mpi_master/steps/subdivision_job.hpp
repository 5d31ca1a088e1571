#pragma once

#include <cstdint>
#include <functional>

#include "core/element.hpp"
#include "core/raster.hpp"
#include "mpi_master/communication/shared_memory.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct Options;

/// All elements, the same on every host, and the raster of those that the camera sees.
struct SubdividedScene {
  SharedArray<Element> elements;  ///< held once a host
  SharedArray<Outline<glm::vec3>> outlines;
  ElementView mesh;        ///< of both
  Raster raster;           ///< empty without a camera
  double max_edge = 0;     ///< [m] in force; infinite where edges are not bounded
  int max_depth = 0;       ///< steps of the deepest tree
  std::uint64_t hash = 0;  ///< of the elements
};

/// Collective: every host gets the elements of all ranks, in the ranks' order, and their hash.
void share_elements(const Communicator& communicator, const ElementView& own, SubdividedScene& subdivided);

/// What a rank needs for so many elements [bytes].
using BytesOfElements = std::function<std::uint64_t(std::size_t elements)>;

/// Collective: each rank holds a sub-scene, renders and splits it. With merged sub-scenes the rasters are
/// merged by depth first, so that the elements are the same for every number of ranks; with independent ones
/// (Debelov & Sattarov, 4.2) each rank splits all that its own raster shows, hidden by other sub-scenes or
/// not. Throws AgreedError where the camera sees nothing that can be lit, or where there is no room for the
/// elements, before they are made. Where elements are to be the leaves of a hierarchy there are none yet,
/// only the raster.
///
/// `bytes_to_follow`: what a rank needs at least for that which is to be made of so many elements; where
/// there is no room for it, that is refused likewise, before a long subdivision.
[[nodiscard]] SubdividedScene subdivide_scene(const Communicator& communicator, const Scene& scene,
                                              const Options& options, int threads,
                                              const BytesOfElements& bytes_to_follow = {});

}  // namespace fluxel

#pragma once

#include <span>
#include <vector>

#include "core/ids.hpp"
#include "visibility/convex_body.hpp"
#include "visibility/occluder.hpp"
#include "visibility/patch_tree.hpp"
#include "visibility/shaft.hpp"

namespace fluxel {

/// Finds the patches that may stand in a shaft, in single precision and many planes at a time. What comes as
/// near the hull as single precision can tell counts as within; `extent` [m] is the scene's. Gives up when
/// there are more than `most`, and says so by false; else `ids` holds them, in the order of the tree.
[[nodiscard]] bool find_occluders(const PatchTree& tree, std::span<const Occluder> occluders,
                                  const Shaft& shaft, float extent, std::size_t most,
                                  std::vector<PatchId>& ids);

/// The same of convex bodies, by their numbers in the tree.
[[nodiscard]] bool find_occluders(const BodyTree& tree, const Shaft& shaft, float extent, std::size_t most,
                                  std::vector<std::uint32_t>& numbers);

}  // namespace fluxel

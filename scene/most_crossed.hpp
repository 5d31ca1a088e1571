#pragma once

#include <string>
#include <vector>

#include "scene/contact_pairs.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// The groups that others touch or cross most often, with the number of times and the patch of theirs that
/// has most of them, as part of a sentence; the most often crossed first, three at most.
[[nodiscard]] std::string most_crossed(const Scene& scene, const std::vector<Contact>& contacts);

}  // namespace fluxel

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "hierarchy/hierarchy.hpp"
#include "method/problem.hpp"

namespace fluxel {

/// Where the links of a solution are kept that stands in this folder.
[[nodiscard]] std::filesystem::path links_folder(const std::filesystem::path& solution_folder);

/// What links depend on of the scene, as long as the hierarchy's tree has not been split.
[[nodiscard]] std::uint64_t scene_of_links(const Problem& problem, const Hierarchy& hierarchy);

/// Collective: keeps the links of a hierarchy that has ended with these rounds, in links_folder of the
/// run, for views of its solution. `scene` is scene_of_links, `B` the radiosity that the solution's file gets
/// [W/m2], on the root. Where that cannot be written it is warned of.
void keep_links(const Problem& problem, const Hierarchy& hierarchy, std::uint64_t scene,
                const std::vector<HierarchyRound>& rounds, std::span<const Rgb> B);

/// Collective: a hierarchy by the links that stand beside Options::solution, whose radiosity is `B` [W/m2],
/// on all ranks. Null where there are none; where they are of another scene or solution, or damaged, which is
/// warned of.
[[nodiscard]] std::unique_ptr<Hierarchy> take_up_links(const Problem& problem, std::span<const Rgb> B);

}  // namespace fluxel

#pragma once

#include <span>
#include <vector>

#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Takes the covered areas from the losers' polygons (one list for each patch, at first its outline alone),
/// adds them to the scene's statistics and names them in its notes. A patch that is wholly covered keeps no
/// polygon. The overlaps come ordered by winner, emitters first, then by loser. Warns of gaps.
void take_covered_areas(Scene& scene, std::span<const Overlap> overlaps, double tolerance,
                        std::vector<std::vector<Polygon>>& polygons);

/// Takes what touches from both polygons where one of them is part of a closed body, whose back nobody sees.
void take_touching_areas(Scene& scene, std::span<const Facing> facing, const std::vector<bool>& of_bodies,
                         double tolerance, std::vector<std::vector<Polygon>>& polygons);

}  // namespace fluxel

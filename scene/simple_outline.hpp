#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "core/element.hpp"
#include "scene/merge_tolerance.hpp"

namespace fluxel {

/// A closed line through places of a plane as a triangle or a parallelogram, where it is one of that `area`
/// [m2]: every place lies within the tolerance of its edges (corners by Ramer 1972 and Douglas & Peucker
/// 1973, no more than four).
[[nodiscard]] std::optional<Outline<std::uint32_t>> simple_outline(std::span<const std::uint32_t> loop,
                                                                   std::span<const glm::dvec3> places,
                                                                   double area,
                                                                   const MergeTolerance& tolerance);

}  // namespace fluxel

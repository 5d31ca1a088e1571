#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "core/element.hpp"
#include "scene/merge_tolerance.hpp"

namespace fluxel {

/// A triangle or a parallelogram, and how far what it stands for is off its edges.
struct SimpleOutline {
  Outline<std::uint32_t> outline;  ///< places
  double deviation = 0;            ///< [m], at most
};

/// A closed line through places of a plane as a triangle or a parallelogram, where it is one: every place
/// lies within the tolerance of its edges (corners by Ramer 1972 and Douglas & Peucker 1973, no more than
/// four). `before` [m] is the deviation that the line has itself, which counts.
[[nodiscard]] std::optional<SimpleOutline> simple_outline(std::span<const std::uint32_t> loop,
                                                          std::span<const glm::dvec3> places, double before,
                                                          const MergeTolerance& tolerance);

}  // namespace fluxel

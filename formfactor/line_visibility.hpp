#pragma once

#include <span>

#include "core/element.hpp"
#include "formfactor/fraction_estimate.hpp"
#include "formfactor/visible_fraction.hpp"

namespace fluxel {

/// The visible fraction of the exchange of two polygons in front of each other past the patches `between`, of
/// which all that stand between must be one. Samples are lines, not rays: from a point of P a line of Q is
/// hidden along the shadows that the patches throw on it, which are intervals, found exactly (as Billen &
/// Dutre 2016 sample lines of luminaires), and what is left is integrated with the kernel. One dimension less
/// to sample, and no steps but kinks: a few lines tell what hundreds of rays do. Until the standard error is
/// at most `wanted`.
[[nodiscard]] FractionEstimate visible_fraction_by_lines(const SampledPolygon& P, const SampledPolygon& Q,
                                                         std::span<const Outline<glm::dvec3>> between,
                                                         std::uint64_t seed, double wanted);

}  // namespace fluxel

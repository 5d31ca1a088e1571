#pragma once

#include <optional>
#include <span>

#include "core/element.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective, when light is known: the irradiance of every receiver's cells by a
/// final gather, two surfaces deep, light from emitters by paths and light from
/// the second surface as the solution has it: `H` [W/m2], an entry an unknown of the mesh, on all ranks. A
/// signal ends the gather alone.
void gather_receivers(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                      Solution& solution);

/// Relative error that the solution is expected to have, root mean square over the mean, beside that of a
/// gather's own rays; none where nothing is known of it. On the root.
[[nodiscard]] std::optional<double> expected_error(const Options& options, const Solution& solution);

}  // namespace fluxel

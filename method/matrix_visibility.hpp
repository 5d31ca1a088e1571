#pragma once

#include "core/element.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {

/// Collective: time, memory and shares of the matrix, predicted from a sample before anything heavy starts.
/// Throws AgreedError where memory does not suffice.
[[nodiscard]] Forecast forecast_visibility(const Problem& problem, const TileTracer& tracer,
                                           const ElementView& mesh, SampleUse use);

/// Collective: the visibility of all pairs, computed or taken from earlier jobs, and kept where the options
/// ask for it; into the solution's statistics, which have the forecast. Throws AgreedError where folders of
/// strips cannot be used, StopRequest after a signal.
[[nodiscard]] Visibility matrix_visibility(const Problem& problem, std::span<const Element> elements,
                                           const TileTracer& tracer, Solution& solution);

/// Says rays, tiles and what was kept.
void say_visibility(const Problem& problem, const Solution& solution);

}  // namespace fluxel

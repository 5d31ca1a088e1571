#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/choices.hpp"
#include "core/element.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/scheduling/tile_sample.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {

/// What a run will need, before anything heavy starts.
struct Forecast {
  std::uint64_t pairs = 0;             ///< unordered pairs of elements
  std::uint64_t bytes = 0;             ///< peak of the rank that needs most, all that it shares included
  std::uint64_t to_come = 0;           ///< on this rank from now on, with its part of what its host shares
  std::uint64_t store_bytes = 0;       ///< of the visibility stores of all ranks together
  std::uint64_t correction_bytes = 0;  ///< of the corrections of form factors, likewise
  double visibility_seconds = 0;       ///< with all threads of all ranks at work
  double mixed_tiles = 0;              ///< fraction of tiles that keep their bits
  RowCosts costs;                      ///< what the work is assigned by
};

/// What the form factors of pairs are corrected by.
struct PairsToCorrect {
  const RayScene& ray_scene;
  const Scene& scene;
  ElementView mesh;
  const FormFactorOptions& options;
};

/// Collective: traces a sample of tiles and extrapolates. Of totals alone the costs are no shares to assign
/// by. `pairs`: counts their corrections in the same tiles, as if light were evenly spread; nothing to
/// correct where it is empty.
[[nodiscard]] Forecast forecast(const Communicator& communicator, const TileTracer& tracer,
                                std::size_t unknowns, int threads, SampleUse use = SampleUse::shares,
                                const std::optional<PairsToCorrect>& pairs = {});

/// A lower bound of a rank's memory for this many elements, with its part of what its host shares [bytes].
[[nodiscard]] std::uint64_t least_bytes(const Communicator& communicator, std::size_t elements);

/// What helps against too many elements.
inline constexpr std::string_view kFewerElements =
    "use more hosts, a smaller --resolution, or larger elements";

/// Collective: throws AgreedError where `bytes` more are not to be had on some rank; `what` names their use,
/// `remedy` what the user may do.
void require_memory(const Communicator& communicator, std::uint64_t bytes, const std::string& what,
                    std::string_view remedy);

}  // namespace fluxel

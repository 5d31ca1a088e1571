#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/element.hpp"
#include "mpi_master/communicator.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// What a run will need, before anything heavy starts.
struct Forecast {
  std::uint64_t pairs = 0;        ///< unordered pairs of elements
  std::uint64_t bytes = 0;        ///< peak of the rank that needs most
  double visibility_seconds = 0;  ///< with all threads of all ranks at work
  double mixed_tiles = 0;         ///< fraction of tiles that keep their bits
};

/// Collective: traces a sample of tiles, spread over the matrix by a fixed seed, and extrapolates.
[[nodiscard]] Forecast forecast(const Communicator& communicator, const RayScene& ray_scene,
                                std::span<const Element> elements, std::size_t unknowns, int threads);

/// A lower bound of a rank's memory for this many elements [bytes].
[[nodiscard]] std::uint64_t least_bytes(const Communicator& communicator, std::size_t elements);

/// Collective: throws AgreedError where `bytes` more are not to be had on some rank; `what` names their use.
void require_memory(const Communicator& communicator, std::uint64_t bytes, const std::string& what);

}  // namespace fluxel

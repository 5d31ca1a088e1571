#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/options.hpp"
#include "core/progress.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "reference/estimation.hpp"

namespace fluxel {

/// How good a measurement shall be, what it may cost, and where its samples go.
struct PathGoal {
  ReferenceLimits limits;
  Sampling sampling = Sampling::even;
  std::uint64_t seed = 1;
  double margin = 1;         ///< it goes on until the error is so many times smaller than what is asked for
  bool is_asked_for = true;  ///< by somebody; else what has light counts as reached, whatever ends it
};

/// How a measurement stood after a pass.
struct ReferencePass {
  std::uint32_t samples = 0;  ///< paths a sensor, in each randomisation; in the mean
  std::uint64_t rays = 0;
  double seconds = 0;            ///< since the start, by this rank's clock
  double processor_seconds = 0;  ///< of all ranks
  Rgb relative_error{0};         ///< as in ReferenceResult
};

/// What ends a measurement.
enum class ReferenceEnding { target, rays, time, signal, nothing, in_vain };

/// As a sentence.
[[nodiscard]] std::string_view sentence_of(ReferenceEnding ending);

/// What has been measured, the same on all ranks but for the sensors and what clocks say.
struct ReferenceResult {
  std::vector<SensorEstimate> sensors;                ///< on the root; elsewhere empty
  std::uint32_t samples = 0;                          ///< paths a sensor, in each randomisation; in the mean
  std::uint32_t least_samples = 0, most_samples = 0;  ///< of a block
  std::uint64_t rays = 0;
  Rgb mean{0};               ///< over all sensors, by weight
  double contributions = 0;  ///< paths that have brought something: their effective number
  /// Root mean square of the standard errors over the mean; 0 where that is 0, and infinite where light that
  /// there is has not been found.
  Rgb relative_error{0};
  Rgb quadratic_error{0};  ///< the same over the root mean square of the values, without what noise adds
  std::vector<ReferencePass> passes;
  bool reached = true;                               ///< the target error, where there is one
  bool stopped = false;                              ///< by a signal; what has been measured is whole
  VerifiedCounts devices;                            ///< of all ranks, since their devices were found
  ReferenceEnding ending = ReferenceEnding::target;  ///< by this rank's clock
  bool partly_before = false;  ///< of photons after a change: some still bring the scene before
};

/// Collective: measures all sensors until a limit is come to, the ranks and their threads a part of them
/// each, in passes of which each adds a quarter to an eighth of what there is, or
/// about 1e8 rays where that is less. `columns`: of sensors that are pixels or cells by rows, which blocks
/// are squares of; else 0. Values depend on the goal and on samples alone; where time is the limit, the clock
/// decides on the samples. At least kMinSamples are made. `device`: this rank's, of these sensors, or null.
/// Throws AgreedError where memory does not suffice, a device that is required fails, or devices find other
/// light than processors.
[[nodiscard]] ReferenceResult measure(const Communicator& communicator, const Sensors& sensors,
                                      std::size_t columns, const PathGoal& goal, int threads,
                                      Progress& progress, DeviceBatch* device = nullptr);

/// Samples, in the mean, from which on an error is believed to have come to its target: of fewer, what is
/// seldom met may be missing in all. Where samples are dealt fewer will do, since they go where light varies,
/// and what is missed in a sensor is met in others of its block.
inline constexpr std::uint32_t kBelievedSamples = 16;
inline constexpr std::uint32_t kBelievedDealtSamples = 8;

/// Of all sensors together: paths, and contributions of them, from which on an error is believed to have come
/// to its target; and paths after which what has brought nothing at all is given up.
inline constexpr double kBelievedPaths = 1 << 14, kBelievedContributions = 64, kPathsInVain = 1 << 22;

}  // namespace fluxel

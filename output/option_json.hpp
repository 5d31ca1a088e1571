#pragma once

#include "output/json_parts.hpp"

namespace fluxel {

struct Options;
struct ReferenceOptions;
struct PhotonOptions;

/// The options in force, by the names of the command line with underscores, lists as arrays (any other value
/// that is no number or truth value as the command line would take it): all that the run's method knows, but
/// the output folder and `--quiet`. An option that has no part in the run is left out.
[[nodiscard]] Json options_json(const Options& options);

/// The same of a reference.
[[nodiscard]] Json options_json(const ReferenceOptions& options);
[[nodiscard]] Json options_json(const PhotonOptions& options);

}  // namespace fluxel

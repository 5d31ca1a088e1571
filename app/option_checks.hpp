#pragma once

#include <string>
#include <vector>

#include "core/options.hpp"

namespace fluxel {

/// Throws InputError for numbers that are out of range whatever the other options are.
void check_numbers(const Options& options);

/// Throws InputError for contradictions and values out of range, before any work.
void check_options(const Options& options);

/// Throws InputError where options, without dashes, belong to other methods, and names all of them and those.
void check_known(const std::vector<std::string>& given, Method method);

/// As check_options, of a reference.
void check_reference_options(const ReferenceOptions& options);

/// Throws InputError where --target-of names none of what is measured.
void require_measured(const ErrorLimits& limits, const std::vector<std::string>& measured);

/// Throws InputError where values of photons contradict each other.
void check_photon_options(const PhotonOptions& options);

}  // namespace fluxel

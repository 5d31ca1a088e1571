#pragma once

#include <filesystem>

#include "method/matrix_statistics.hpp"

namespace fluxel {

/// Writes what ranks did when, in the phases in which work is scheduled, as CSV:
/// `phase,rank,kind,start_s,end_s`, a line for each stretch of time; kind is compute, messages or wait, times
/// are from the phase's start. Throws InputError where it cannot.
void write_timeline(const std::filesystem::path& file, const MatrixStatistics& statistics);

}  // namespace fluxel

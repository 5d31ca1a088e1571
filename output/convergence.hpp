#pragma once

#include <filesystem>
#include <string>

#include "metrics/progress_recorder.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

struct Options;

/// Writes what long phases have shown until now as CSV: `phase,seconds,done,error,target,forecast_s`, a line
/// a sample, fields that are not known empty. Throws InputError where it cannot.
void write_convergence(const std::filesystem::path& file, const std::vector<PhaseRecord>& phases);

/// Writes convergence.csv, and with Options::live the page of that name, into the run's folder while phases
/// run, on the root, for those who watch. What cannot be written then is left out: no run ends for it.
[[nodiscard]] ProgressRecorder::Keep keep_convergence(const Communicator& world, const Options& options,
                                                      const std::string& page);

}  // namespace fluxel

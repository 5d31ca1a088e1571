#pragma once

#include <filesystem>
#include <string>

#include "mpi_master/communication/communicator.hpp"
#include "photons/tally_file.hpp"

namespace fluxel {

/// Collective: the tally that an earlier job has kept in a file of the root, on all ranks. Throws AgreedError
/// where there is none, or one that does not belong to this job, with `hint` what to do.
[[nodiscard]] PhotonTally restore_tally(const Communicator& communicator, const std::filesystem::path& file,
                                        const TallyKey& key, const TallyShape& shape,
                                        const std::string& hint = "or leave --resume out");

}  // namespace fluxel

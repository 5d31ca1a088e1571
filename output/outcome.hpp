#pragma once

#include <string>

#include "output/run_record.hpp"

namespace fluxel {

/// What a run was asked for and has not come to, as a sentence that its files say; empty where its exit code
/// is 0.
[[nodiscard]] std::string unreached(const RunRecord& record);

/// Likewise of what a reference or a receiver has measured.
[[nodiscard]] std::string unreached(const ReferenceResult& measured);

}  // namespace fluxel

#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/tile_examiner.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

/// To see that a tile has no work [s].
inline constexpr double kLookSeconds = 5e-8;

/// What is known of a rank's rows before their corrections are looked for.
struct CorrectionsSurvey {
  std::vector<double> seconds;  ///< of each owned row's tiles (row, column >= row), on one thread, predicted
  std::uint64_t tiles = 0;      ///< that have work and meet owned rows, each once
};

[[nodiscard]] CorrectionsSurvey survey_corrections(const TileExaminer& examiner, const TileStore& store,
                                                   int threads);

}  // namespace fluxel

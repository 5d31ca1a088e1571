#include "mpi_master/steps/corrections_survey.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <numeric>

namespace fluxel {

CorrectionsSurvey survey_corrections(const TileExaminer& examiner, const TileStore& store, int threads) {
  const TileRows& rows = store.owned();
  CorrectionsSurvey result{std::vector<double>(rows.size()), 0};
  std::vector<std::uint64_t> tiles(rows.size());
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(rows.first, rows.last, [&](std::size_t row) {
      double& seconds = result.seconds[row - rows.first];
      for (std::size_t column = 0; column < store.tiles(); ++column) {
        seconds += kLookSeconds;
        // A tile of two owned rows is the lower one's.
        if ((column < row && rows.contains(column)) || !examiner.has_work(row, column)) continue;
        ++tiles[row - rows.first];
        if (column >= row) seconds += examiner.predicted_seconds(row, column, store.tag(row, column));
      }
    });
  });
  result.tiles = std::accumulate(tiles.begin(), tiles.end(), std::uint64_t{0});
  return result;
}

}  // namespace fluxel

#include "mpi_master/steps/corrections_job.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "small_scenes.hpp"
#include "solver/unknowns.hpp"
#include "tests/unit/serial_corrections.hpp"
#include "tests/unit/test_scenes.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

FormFactorOptions adaptive() {
  FormFactorOptions options;
  options.tolerance = 5e-3;
  return options;
}

FormFactorOptions by_points() {
  FormFactorOptions options;
  options.rule = FormFactor::points;
  options.points = {1, 2};
  return options;
}

/// A light here and there, so that pairs of every kind are found.
PowerEstimate some_power(std::size_t unknowns) {
  PowerEstimate power{std::vector<double>(unknowns, 1), std::vector<double>(unknowns, 1)};
  for (std::size_t k = 0; k < unknowns; k += 150) power.B[k] = 30;
  return power;
}

/// A scene with the bits of this rank's rows and, for comparison, of all rows.
struct System {
  Scene scene;
  SubdividedScene subdivided;
  RayScene ray_scene;
  Visibility visibility;
  TileStore all;
  PowerEstimate power;

  /// `owning`: what rows cost their owners.
  System(const SolveRequest& request, std::vector<double> (*owning)(std::size_t))
      : scene(scene_of(request)),
        subdivided(subdivide_scene(world(), scene, request.options, 1)),
        ray_scene(scene, 1),
        visibility(traced(owning)),
        all(test_scenes::traced(ray_scene, subdivided.mesh.elements)),
        power(some_power(make_unknowns(subdivided.mesh.elements, scene.materials).size())) {}

  [[nodiscard]] std::size_t tiles() const { return tile_count(subdivided.mesh.elements.size()); }
  [[nodiscard]] TileExaminer examiner(const FormFactorOptions& options) const {
    return {ray_scene, scene, subdivided.mesh, options, power};
  }

 private:
  [[nodiscard]] Visibility traced(std::vector<double> (*owning)(std::size_t)) const {
    RowCosts costs = RowCosts::even(tiles(), 1e-4);
    costs.solve = owning(tiles());
    SilentProgress progress;
    return compute_visibility({world(), 1, progress}, TileTracer(ray_scene, subdivided.mesh.elements), costs);
  }
};

std::vector<double> even(std::size_t rows) { return std::vector<double>(rows, 1); }

/// Most rows are the first rank's, and most ranks own none: whatever these examine they have to ask for.
std::vector<double> nearly_all_by_one(std::size_t rows) {
  std::vector<double> costs(rows, 1e-3);
  costs.back() = 1;
  return costs;
}

/// Returns the counts of all pairs.
CorrectionCounts check_equal_to_serial(const System& system, const FormFactorOptions& options) {
  const TileExaminer examiner = system.examiner(options);
  const TileExaminer::Found all = test_scenes::examine_all(examiner, system.all);
  const TileRows own = system.visibility.owners.rows(world().rank());
  std::vector<CorrectionEntry> of_own_rows;
  for (const CorrectionEntry& entry : all.entries)
    if (own.contains(entry.row % examiner.elements() / kTileSize)) of_own_rows.push_back(entry);
  const Corrections expected = compress(CorrectionList(of_own_rows), examiner.unknowns());
  for (const int threads : {1, 2}) {
    SilentProgress progress;
    const FoundCorrections found = find_corrections({world(), threads, progress}, examiner,
                                                    system.visibility.owners, system.visibility.store);
    EXPECT_EQ(found.corrections.start, expected.start);
    EXPECT_EQ(found.corrections.column, expected.column);
    EXPECT_EQ(found.corrections.G, expected.G);
    EXPECT_EQ(found.counts.near_pairs, all.counts.near_pairs) << "each pair is examined once";
    EXPECT_EQ(found.counts.partial_pairs, all.counts.partial_pairs);
    EXPECT_EQ(found.counts.clipped_pairs, all.counts.clipped_pairs);
    EXPECT_EQ(found.counts.rays, all.counts.rays);
    std::uint64_t tiles = 0;
    for (const Activity& activity : found.schedule.of_ranks) tiles += activity.tiles;
    EXPECT_EQ(tiles, system.tiles() * (system.tiles() + 1) / 2);
  }
  return all.counts;
}

TEST(CorrectionsJob, EqualsExaminingTileAfterTile) {
  for (const NamedRequest& named : small_requests()) {
    SCOPED_TRACE(named.name);
    const System system(named.request, even);
    check_equal_to_serial(system, adaptive());
  }
}

TEST(CorrectionsJob, PointsEqualExaminingTileAfterTile) {
  const System system(scene_request("cornell-box", {"--resolution", "12x12"}), even);
  ASSERT_GT(system.tiles(), 2u);
  EXPECT_GT(check_equal_to_serial(system, by_points()).rays, 1000u);
}

TEST(CorrectionsJob, TilesThatAreNotHeldAreAskedFor) {
  const System system(scene_request("cornell-box", {"--resolution", "24x24"}), nearly_all_by_one);
  EXPECT_GE(system.visibility.owners.rows(0).size(), system.tiles() - 1);
  const CorrectionCounts counts = check_equal_to_serial(system, adaptive());
  // Else the comparison would say little.
  EXPECT_GT(counts.near_pairs, 100u);
  EXPECT_GT(counts.partial_pairs, 100u);
  EXPECT_GT(counts.clipped_pairs, 100u);
  EXPECT_GT(counts.rays, 1000u);
}

TEST(CorrectionsJob, WhereOneRankHasNoRoomAllEndWithASentence) {
  const System system(scene_request("cornell-box", {"--resolution", "24x24"}), even);
  const FormFactorOptions options = by_points();
  const TileExaminer examiner = system.examiner(options);
  const AvailableBytes available = [] { return world().is_root() ? 0 : std::uint64_t{1} << 40; };
  SilentProgress progress;
  try {
    static_cast<void>(find_corrections({world(), 1, progress}, examiner, system.visibility.owners,
                                       system.visibility.store, available));
    FAIL() << "there is no room";
  } catch (const AgreedError& error) {
    EXPECT_NE(std::string(error.what()).find("not enough memory: rank 0 has found"), std::string::npos)
        << error.what();
  }
  // And the next job finds no message of this one.
  check_equal_to_serial(system, adaptive());
}

}  // namespace
}  // namespace fluxel::test

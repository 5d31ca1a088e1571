// What is forecast of corrections, and what there is.
#include "mpi_master/steps/forecast.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include "formfactor/sampled_entries.hpp"
#include "mpi_master/steps/form_factor_matrix.hpp"
#include "mpi_master/steps/own_rows.hpp"
#include "mpi_master/steps/side_view_job.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "small_scenes.hpp"
#include "solver/estimate_power.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

struct CorrectionBytes {
  double forecast, found;
};

/// Of the corrections of all ranks, without where their rows begin.
CorrectionBytes correction_bytes(const SolveRequest& request) {
  const FormFactorOptions& options = request.options.form_factor;
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const ElementView& mesh = subdivided.mesh;
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, mesh.elements);
  const Unknowns unknowns = make_unknowns(mesh.elements, scene.materials);
  const Forecast predicted = forecast(world(), tracer, unknowns.active, 1, SampleUse::shares,
                                      PairsToCorrect{ray_scene, scene, mesh, options});
  SilentProgress progress;
  const Visibility visibility = compute_visibility({world(), 1, progress}, tracer, predicted.costs);
  const SharedArray<SideView> views =
      gather_side_views(world(), ray_scene, scene, mesh, unknowns.two_sided, 1);
  const OwnRows own(visibility.store.owned(), mesh.elements.size(), unknowns.two_sided);
  const Unknowns own_unknowns =
      make_unknowns(own.of_elements(mesh.elements), scene.materials, unknowns.two_sided);
  const std::vector<SideView> own_views = own.of(views.items());
  const FormFactorMatrix matrix(
      {world(), 1, progress},
      {ray_scene, scene, mesh, visibility, unknowns.two_sided, own_unknowns, own_views}, options);
  const std::uint64_t starts = ranks() * sizeof(std::uint64_t) * (unknowns.size() + 1);
  return {static_cast<double>(predicted.correction_bytes),
          static_cast<double>(matrix.statistics().correction_bytes - starts)};
}

TEST(Forecast, BytesOfCorrectionsAreNear) {
  const SolveRequest requests[] = {
      scene_request("cornell-box", {"--resolution", "48x48"}),
      scene_request("cornell-box", {"--resolution", "24x24", "--form-factor", "points:1x2"}),
      scene_request("corridor", {"--resolution", "48x48"}),
      scene_request("cube-in-cube", {"--subdivision", "uniform", "--max-edge", "0.1"}),
      scene_request("emitting-wall", {"--subdivision", "uniform", "--max-edge", "0.05"})};
  for (const SolveRequest& request : requests) {
    SCOPED_TRACE(request.options.scene);
    const CorrectionBytes bytes = correction_bytes(request);
    // Some lines of some tiles, as if light were evenly spread.
    EXPECT_GT(bytes.forecast, 0.7 * bytes.found);
    EXPECT_LT(bytes.forecast, 1.4 * bytes.found);
    EXPECT_GT(bytes.found, 1e5) << "else they would say little";
  }
}

TEST(Forecast, SampledLinesStandForAll) {
  SolveRequest request = scene_request("cornell-box", {"--resolution", "12x12"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const ElementView& mesh = subdivided.mesh;
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, mesh.elements);
  const PowerEstimate power = even_power(make_unknowns(mesh.elements, scene.materials));
  for (const FormFactor rule : {FormFactor::adaptive, FormFactor::points}) {
    request.options.form_factor.rule = rule;
    const TileExaminer examiner(ray_scene, scene, mesh, request.options.form_factor, power);
    ASSERT_TRUE(examiner.has_work(0, 1));
    const TracedTile tile = tracer.trace(0, 1);
    const std::uint64_t all = sampled_entries(examiner, 0, 1, tile, 1e3, 7);
    EXPECT_GT(all, 100u);
    const double of_tile = examiner.predicted_seconds(0, 1, tile.tag);
    // A line in four, and the lines of every fourth tile.
    for (const std::uint64_t parts : {std::uint64_t{4}, std::uint64_t{4} * kTileSize}) {
      std::uint64_t sum = 0;
      for (std::uint64_t chance = 0; chance < parts; ++chance)
        sum += sampled_entries(examiner, 0, 1, tile, of_tile / static_cast<double>(parts), chance);
      EXPECT_EQ(sum, parts * all);
    }
  }
}

TEST(Forecast, CorrectionsAreAskedFor) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "48x48"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const ElementView& mesh = subdivided.mesh;
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, mesh.elements);
  FormFactorOptions options;
  const auto forecast_by = [&](FormFactor rule) {
    options.rule = rule;
    return forecast(world(), tracer, mesh.elements.size(), 1, SampleUse::shares,
                    PairsToCorrect{ray_scene, scene, mesh, options});
  };
  const Forecast disc = forecast_by(FormFactor::disc), points = forecast_by(FormFactor::points);
  EXPECT_EQ(disc.correction_bytes, 0u);
  // Points correct most pairs that see each other, in 8 bytes each way: of these pairs here some two in five.
  const auto pairs = static_cast<double>(disc.pairs);
  EXPECT_GT(static_cast<double>(points.correction_bytes), 0.1 * 16 * pairs);
  // The largest rank has an even share at least.
  const double more = static_cast<double>(points.to_come) - static_cast<double>(disc.to_come);
  EXPECT_GT(more, 0.9 * static_cast<double>(points.correction_bytes) / static_cast<double>(ranks()));
}

}  // namespace
}  // namespace fluxel::test

#include "method/matrix_visibility.hpp"

#include <fmt/format.h>

#include "core/element.hpp"
#include "core/options.hpp"
#include "method/say_checkpoint.hpp"
#include "method/say_devices.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "visibility/visibility_identity.hpp"

namespace fluxel {

namespace {

/// Where the tiles come from, if not all of them have been computed here.
std::string origin_text(const Options& options, const VisibilityCounts& counts) {
  if (options.reuse_visibility.empty() && !options.resume) return {};
  return fmt::format(", {} tiles kept by an earlier run", counts.tiles_resumed);
}

/// More would not be rays that end in a patch's plane: of the pairs, and where few are compared.
constexpr double kMaxDifferent = 1e-6, kAlwaysAllowed = 8;

void warn_of_differences(Log& log, const DeviceCounts& counts) {
  if (static_cast<double>(counts.differing_bits) >
      kAlwaysAllowed + kMaxDifferent * static_cast<double>(counts.verified_pairs))
    log.warn(
        fmt::format("a GPU and the processor differ in {} of {} pairs that both have made: the "
                    "GPU or its driver may be faulty (use --device cpu)",
                    counts.differing_bits, counts.verified_pairs));
}

}  // namespace

Forecast forecast_visibility(const Problem& problem, const TileTracer& tracer, const ElementView& mesh,
                             SampleUse use) {
  Forecast found =
      forecast(problem.world, tracer, count_unknowns(mesh.elements).active, problem.threads, use,
               PairsToCorrect{problem.ray_scene, problem.scene, mesh, problem.options.form_factor});
  problem.log.say(fmt::format("forecast: {:.4g} pairs, {:.3g} GiB on the largest rank, visibility {:.1f} s",
                              static_cast<double>(found.pairs), static_cast<double>(found.bytes) * 0x1p-30,
                              found.visibility_seconds));
  require_memory(problem.world, found.to_come, "the run", kFewerElements);
  return found;
}

Visibility matrix_visibility(const Problem& problem, std::span<const Element> elements,
                             const TileTracer& tracer, Solution& solution) {
  const Options& options = problem.options;
  MatrixStatistics& statistics = *solution.matrix;
  const StripFileKey key{visibility_identity(problem.ray_scene, elements), elements.size()};
  Checkpoint checkpoint(problem.world, options, key,
                        [&](const std::string& sentence) { problem.log.warn(sentence); });
  const TileDevices devices = find_tile_devices(problem.world, options, problem.ray_scene, elements, tracer);
  statistics.gpu_ranks = devices.job.ranks;
  statistics.gpus = devices.job.names;
  say_devices(devices.job, problem.world.size(), problem.log);
  Visibility visibility = compute_visibility(workers_of(problem), tracer, statistics.forecast.costs,
                                             checkpoint, devices.own.get());
  if (checkpoint.keeps()) {
    if (!visibility.not_kept.empty() && options.visibility_only)
      throw AgreedError("the visibility is not kept: " + visibility.not_kept);
    if (!visibility.not_kept.empty())
      problem.log.warn("the checkpoint is not complete: " + visibility.not_kept);
    solution.checkpoint = checkpoint.counts();
  }
  statistics.visibility = visibility.counts;
  statistics.visibility_hash = visibility.hash;
  statistics.visibility_makers = visibility.makers;
  statistics.visibility_schedule = visibility.schedule;
  warn_of_device_failures("visibility", visibility.device_failures, problem.log);
  warn_of_differences(problem.log, visibility.counts.device);
  return visibility;
}

void say_visibility(const Problem& problem, const Solution& solution) {
  const VisibilityCounts& counts = *solution.matrix->visibility;
  problem.log.say(fmt::format(
      "visibility: {:.4g} rays, {} of {} tiles uniform, {:.3g} GiB in all{}, {:.2f} s",
      static_cast<double>(counts.rays), counts.tiles_uniform, counts.tiles_uniform + counts.tiles_mixed,
      static_cast<double>(counts.store_bytes) * 0x1p-30, origin_text(problem.options, counts),
      solution.time.visibility.wall));
  say_checkpoint(problem, solution);
}

}  // namespace fluxel

#include "app/visibility_step.hpp"

#include <fmt/format.h>

#include "mpi_master/agreement.hpp"
#include "visibility/visibility_identity.hpp"

namespace fluxel {

namespace {

/// Where the tiles come from, if not all of them have been computed here.
std::string origin_text(const Options& options, const VisibilityCounts& counts) {
  if (options.reuse_visibility.empty() && !options.resume) return {};
  return fmt::format(", {} tiles kept by an earlier run", counts.tiles_resumed);
}

}  // namespace

Visibility visibility_step(const Communicator& world, const RayScene& ray_scene,
                           std::span<const Element> elements, const TileTracer& tracer, int threads,
                           const Teller& teller, Progress& progress, RunReport& report) {
  const Options& options = report.options;
  const StripFileKey key{visibility_identity(ray_scene, elements), elements.size()};
  Checkpoint checkpoint(world, options, key,
                        [&](const std::string& sentence) { teller.warn(report, sentence); });
  Visibility visibility =
      compute_visibility(world, tracer, report.forecast.costs, threads, checkpoint, progress);
  if (checkpoint.keeps()) {
    if (!visibility.not_kept.empty() && options.visibility_only)
      throw AgreedError("the visibility is not kept: " + visibility.not_kept);
    if (!visibility.not_kept.empty())
      teller.warn(report, "the checkpoint is not complete: " + visibility.not_kept);
    report.checkpoint = checkpoint.counts();
  }
  const VisibilityCounts& counts = visibility.counts;
  report.visibility = counts;
  report.visibility_hash = visibility.hash;
  report.visibility_dealt = visibility.dealt;
  return visibility;
}

void describe_visibility(const Teller& teller, const RunReport& report) {
  const VisibilityCounts& counts = *report.visibility;
  teller.say("visibility: {:.4g} rays, {} of {} tiles uniform, {:.3g} GiB in all{}, {:.2f} s",
             static_cast<double>(counts.rays), counts.tiles_uniform,
             counts.tiles_uniform + counts.tiles_mixed, static_cast<double>(counts.store_bytes) * 0x1p-30,
             origin_text(report.options, counts), report.time.visibility.wall);
  if (report.checkpoint) describe_checkpoint(teller, report);
}

}  // namespace fluxel

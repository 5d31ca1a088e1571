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

/// Which GPUs make tiles, and in how many ranks; why not where a user may have expected one.
void describe_devices(const Teller& teller, const JobDevices& devices, int ranks, RunReport& report) {
  report.gpu_ranks = devices.ranks;
  report.gpus = devices.names;
  if (devices.ranks > 0)
    teller.say("GPUs: {}, in {} of {} ranks", fmt::join(devices.names, ", "), devices.ranks, ranks);
  if (!devices.without.empty())
    teller.say("note: {} of {} ranks work without a GPU: {}", devices.without.size(), ranks,
               devices.without.front().reason);
}

/// More would not be rays that end in a patch's plane: of the pairs, and where few are compared.
constexpr double kMostDifferent = 1e-6, kAlwaysAllowed = 8;

void warn_of_differences(const Teller& teller, const DeviceCounts& counts, RunReport& report) {
  if (static_cast<double>(counts.differing_bits) >
      kAlwaysAllowed + kMostDifferent * static_cast<double>(counts.verified_pairs))
    teller.warn(report,
                fmt::format("a GPU and the processor differ in {} of {} pairs that both have made: the "
                            "GPU or its driver may be faulty (use --device cpu)",
                            counts.differing_bits, counts.verified_pairs));
}

}  // namespace

Visibility visibility_step(const Communicator& world, const RayScene& ray_scene,
                           std::span<const Element> elements, const TileTracer& tracer, int threads,
                           const Teller& teller, Progress& progress, RunReport& report) {
  const Options& options = report.options;
  const StripFileKey key{visibility_identity(ray_scene, elements), elements.size()};
  Checkpoint checkpoint(world, options, key,
                        [&](const std::string& sentence) { teller.warn(report, sentence); });
  const JobDevices devices = find_job_devices(world, options, ray_scene, elements, tracer);
  describe_devices(teller, devices, world.size(), report);
  Visibility visibility = compute_visibility(world, tracer, report.forecast.costs, threads, checkpoint,
                                             progress, devices.own.get());
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
  report.visibility_makers = visibility.makers;
  warn_of_device_failures("visibility", visibility.device_failures, teller, report);
  warn_of_differences(teller, counts.device, report);
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

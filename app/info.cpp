#include "app/info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <span>
#include <string>

#include "app/run_log.hpp"
#include "core/error.hpp"
#include "core/options.hpp"
#include "method/load_scene.hpp"
#include "method/methods.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/transfer.hpp"
#include "optics/luminaire_doubts.hpp"
#include "output/scene_text.hpp"
#include "reference/receiver_doubts.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// On the root: why nothing is forecast, as a sentence, or nothing.
std::string why_no_forecast(const Scene& scene) {
  const auto message_of = [&](const auto& check) -> std::string {
    try {
      check();
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  const std::string unsolvable = message_of([&] { require_emitter(scene); });
  if (!unsolvable.empty()) return "No solve: " + unsolvable;
  const std::string unknown = message_of([&] { require_convection_known(scene, Method::hierarchical); });
  return unknown.empty() ? unknown : "No forecast: " + unknown;
}

}  // namespace

int run_info(const Communicator& world, const InfoRequest& request, ProgressDisplay& display) {
  // 1. Load: everybody gets the options and the scene, whether or not it emits.
  Options options = request.options;
  broadcast(world, options);
  agree(world, [&] { use_instruction_set(options.isa); });
  const int threads = rank_places(world, options.threads)[static_cast<std::size_t>(world.rank())].threads;
  RunLog log(world, options.quiet);
  ProgressRecorder progress(display);
  progress.begin("load");
  Scene scene;
  std::uint64_t without_forecast = 0;
  on_root(world, [&] { scene = build_scene(request.input, scene_settings(options, threads), &progress); });
  progress.end();

  // 2. What it holds.
  on_root(world, [&] {
    const std::string reason = why_no_forecast(scene);
    LuminaireDoubts luminaires;
    if (!scene.luminaires.empty() || !scene.receivers.empty()) {
      const RayScene ray_scene(scene, threads);
      luminaires = luminaire_doubts(ray_scene);
      std::ranges::move(receiver_doubts(ray_scene), std::back_inserter(luminaires.warnings));
    }
    log.say(scene_text(request.input, scene, luminaires));
    if (!reason.empty()) log.say("\n" + reason);
    without_forecast = reason.empty() ? 0 : 1;
  });
  world.all_sum(std::span(&without_forecast, 1));  // the others have 0
  if (without_forecast != 0) return 0;

  // 3. What a solve would take.
  broadcast(world, scene);
  const RayScene ray_scene(scene, threads);
  const Problem problem{.world = world,
                        .scene = scene,
                        .ray_scene = ray_scene,
                        .sensors = sensors_of(options, scene),
                        .options = options,
                        .threads = threads,
                        .progress = progress,
                        .log = log};
  log.say(fmt::format("\nForecast of a solve to {:.2g} % of the {}, by its first rounds:",
                      100 * options.target_error.value_or(kTargetError),
                      error_is_of_picture(options) ? "picture" : "surfaces"));
  static_cast<void>(row_of(Method::hierarchical).forecast(problem));
  return 0;
}

}  // namespace fluxel

#pragma once

#include "core/choices.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

struct Options;

/// How the run's options make a scene, by so many threads.
[[nodiscard]] SceneSettings scene_settings(const Options& options, int threads);

/// Throws InputError where faces have convection, what they send following from their temperatures, and the
/// method does not find these.
void require_convection_known(const Scene& scene, Method method);

/// Collective: builds the scene of a run that computes light or heat, by the root's threads, for everybody.
/// Throws AgreedError where there is nothing to compute or nothing emits, or the options' method does not
/// know convection. `progress`, of a phase that has begun, is reported to where building takes long.
[[nodiscard]] Scene load_scene(const Communicator& world, const Options& options, int threads,
                               const SceneInput& input, Progress* progress = nullptr);

}  // namespace fluxel

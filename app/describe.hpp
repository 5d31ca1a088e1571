#pragma once

#include <optional>
#include <vector>

#include "core/log.hpp"
#include "method/solution.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/communication/machine.hpp"
#include "output/run_record.hpp"
#include "scene/scene.hpp"
#include "scene/scene_input.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

struct Options;

// What a run says of itself beside what its method says.

/// What was read.
void describe_scene(const Options& options, const Scene& scene, Log& log);

/// Collective: what is suspicious of where luminaires and receivers are.
void describe_places(const Communicator& world, const RayScene& ray_scene, Log& log);

/// Which of the scene's cameras is taken, where there are several.
void describe_camera(const std::optional<Camera>& camera, const SceneInput& input, Log& log);

/// Where the ranks run, with warnings of launches that waste the machine.
void describe_ranks(const Options& options, const std::vector<RankPlace>& places, Log& log);

/// Iterations, error and energy of the finished solve; warns where much of the energy is unaccounted for, and
/// where nearly all of it escapes.
void describe_solution(const RunRecord& record, Log& log);

/// Mean, minimum and uniformity U0 of what each receiver gets, with their errors.
void describe_receivers(const RunRecord& record, Log& log);

/// The picture and the solution, or a warning that they are not written.
void describe_outputs(bool written, const RunRecord& record, Log& log);

}  // namespace fluxel

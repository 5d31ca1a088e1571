#pragma once

#include "core/log.hpp"
#include "method/solution.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct Options;

/// Collective: solves a scene of load_scene by the hierarchical or the matrix method, for programs that link
/// Fluxel. All ranks give the same scene and options; those of the matrix method name a subdivision. Reads
/// and writes no files but the checkpoints that the options name. The root's solution has the radiosity of
/// all unknowns, in the order of make_unknowns(solution.subdivided.mesh.elements, scene.materials). What to
/// know before trusting it goes to `log` as warnings.
///
/// Throws InputError where the options do not fit, AgreedError where memory does not suffice, StopRequest
/// where a signal has ended the run. The hierarchical method catches SIGINT and SIGTERM meanwhile.
[[nodiscard]] Solution solve_scene(const Communicator& world, const Scene& scene, const Options& options,
                                   Log& log);

}  // namespace fluxel

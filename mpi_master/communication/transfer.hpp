#pragma once

#include "mpi_master/communication/communicator.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct Options;
struct ReferenceOptions;
struct PhotonOptions;
struct ViewFactorOptions;

/// Collective: the root's options and scene for everybody. The communicator is ordered by hosts, whose ranks
/// hold the scene's patches and pieces together.
void broadcast(const Communicator& communicator, Options& options);
void broadcast(const Communicator& communicator, ReferenceOptions& options);
void broadcast(const Communicator& communicator, PhotonOptions& options);
void broadcast(const Communicator& communicator, ViewFactorOptions& options);
void broadcast(const Communicator& communicator, Scene& scene);

}  // namespace fluxel

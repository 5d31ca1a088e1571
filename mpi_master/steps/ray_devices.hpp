#pragma once

#include <memory>
#include <string>

#include "hierarchy/verified_hits.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/steps/rank_device.hpp"
#include "reference/light_paths.hpp"
#include "reference/verified_paths.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

struct Options;

/// The GPUs of a job that follow paths of light.
struct PathDevices {
  std::unique_ptr<VerifiedPaths> own;  ///< of this rank, where it has one
  JobDevices job;
};

/// Collective: see find_job_devices. `paths`, without a finished solution, must outlive what is returned.
[[nodiscard]] PathDevices find_path_devices(const Communicator& world, const Options& options,
                                            const RayScene& ray_scene, const LightPaths& paths);

/// The GPUs of a job that find what rays meet first.
struct HitDevices {
  std::unique_ptr<VerifiedHits> own;  ///< of this rank, where it has one
  JobDevices job;
};

/// Collective: see find_job_devices. The ray scene must outlive what is returned.
[[nodiscard]] HitDevices find_hit_devices(const Communicator& world, const Options& options,
                                          const RayScene& ray_scene);

/// Collective: of all ranks. Throws AgreedError where GPUs and processors differ in more than this share of
/// `what`, as paths of light.
[[nodiscard]] VerifiedCounts require_same(const Communicator& world, const VerifiedCounts& own,
                                          const std::string& what, double share);

}  // namespace fluxel

#include "mpi_master/steps/ray_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/options.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "reference/cuda/device_paths.hpp"
#include "reference/path_device.hpp"
#include "visibility/cuda/device_hits.hpp"
#include "visibility/device_scene.hpp"

namespace fluxel {

PathDevices find_path_devices(const Communicator& world, const Options& options, const RayScene& ray_scene,
                              const LightPaths& paths) {
  const bool is_diffuse = std::ranges::all_of(ray_scene.scene().patches, [&](const Patch& patch) {
    return ray_scene.scene().material(patch).is_diffuse();
  });
  constexpr const char* kDiffuseAlone = "GPUs follow paths between diffuse surfaces alone";
  agree(world, [&] {
    if (!is_diffuse && options.device == Device::cuda)
      throw InputError(std::string(kDiffuseAlone) + ": leave out --device");
  });
  PathDevices devices;
  devices.job = find_job_devices(world, options.device, [&](const RankDevice& own) {
    if (!ray_scene.scene().luminaires.empty())
      throw cuda::DeviceError("paths of light on a GPU find no luminaires; the processor's do");
    if (!is_diffuse) throw cuda::DeviceError(kDiffuseAlone);
    devices.own = std::make_unique<VerifiedPaths>(
        std::make_unique<cuda::DevicePaths>(path_arrays(ray_scene), own.number, own.memory), paths,
        options.verify_device, options.device == Device::cuda);
  });
  return devices;
}

HitDevices find_hit_devices(const Communicator& world, const Options& options, const RayScene& ray_scene) {
  HitDevices devices;
  devices.job = find_job_devices(world, options.device, [&](const RankDevice& own) {
    const cuda::SceneArrays arrays = device_scene(ray_scene, {});
    devices.own =
        std::make_unique<VerifiedHits>(std::make_unique<cuda::DeviceHits>(arrays, own.number, own.memory),
                                       patches_of(arrays), ray_scene, options.verify_device);
  });
  return devices;
}

VerifiedCounts require_same(const Communicator& world, const VerifiedCounts& own, const std::string& what,
                            double share) {
  std::array sums{own.made, own.verified, own.differing};
  world.all_sum(sums);
  const VerifiedCounts all{sums[0], sums[1], sums[2]};
  if (differs_too_often(all, share))
    throw AgreedError(
        fmt::format("a GPU and the processor differ in {} of {} {} that both have traced: the GPU or its "
                    "driver may be faulty (use --device cpu)",
                    all.differing, all.verified, what));
  return all;
}

}  // namespace fluxel

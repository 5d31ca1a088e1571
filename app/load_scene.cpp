#include "app/load_scene.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/transfer.hpp"

namespace fluxel {

SceneSettings scene_settings(const Options& options, int threads) {
  SceneSettings settings{options.sides, options.ke, options.cut, std::nullopt};
  if (options.camera) settings.camera_eye = options.camera->eye;
  settings.thermal = options.thermal;
  settings.merge = options.merge;
  settings.textures = options.textures;
  settings.threads = threads;
  return settings;
}

void require_convection_known(const Scene& scene, Method method) {
  if (method == Method::matrix) return;
  for (const Patch& patch : scene.patches)
    if (const Material& material = scene.material(patch); material.has_convection())
      throw InputError(fmt::format(
          "material '{}' has a convection_coefficient, for which only 'fluxel solve --method matrix' finds "
          "the "
          "temperatures: give that option, or method = \"matrix\" under [options] of the scene file",
          material.name));
}

Scene load_scene(const Communicator& world, const Options& options, int threads, const SceneInput& input,
                 Progress* progress) {
  Scene scene;
  on_root(world, [&] {
    scene = build_scene(input, scene_settings(options, threads), progress);
    require_emitter(scene);
    require_convection_known(scene, options.method);
  });
  broadcast(world, scene);
  return scene;
}

}  // namespace fluxel

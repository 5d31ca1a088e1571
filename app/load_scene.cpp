#include "app/load_scene.hpp"

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

Scene load_scene(const Communicator& world, const Options& options, int threads, const SceneInput& input,
                 Progress* progress) {
  Scene scene;
  on_root(world, [&] {
    scene = build_scene(input, scene_settings(options, threads), progress);
    require_emitter(scene);
  });
  broadcast(world, scene);
  return scene;
}

}  // namespace fluxel

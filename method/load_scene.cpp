#include "method/load_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/options.hpp"
#include "method/bake.hpp"
#include "method/gathered_picture.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/transfer.hpp"

namespace fluxel {

SceneSettings scene_settings(const Options& options, int threads) {
  SceneSettings settings{options.sides, options.ke, options.cut, std::nullopt};
  if (options.camera) settings.camera_eye = options.camera->eye;
  settings.thermal = options.thermal;
  settings.merge = options.merge;
  settings.textures = options.textures;
  settings.specular = options.specular;
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

namespace {

/// What is gathered at points takes what the materials send, which is known of given temperatures alone.
void require_convection_ungathered(const Scene& scene, const Options& options) {
  const bool has_convection = std::ranges::any_of(
      scene.patches, [&](const Patch& patch) { return scene.material(patch).has_convection(); });
  if (!has_convection) return;
  if (!scene.receivers.empty())
    throw InputError(
        "receivers do not know what faces with a convection_coefficient send: leave [[receivers]] out, or "
        "give "
        "these faces temperatures");
  if (bakes(options))
    throw InputError(
        "meshes and light maps that are gathered do not know what faces with a convection_coefficient send: "
        "leave --mesh-max-edge and --write lightmap out");
  if (gathers_picture(options))
    throw InputError(
        "pictures that are gathered do not know what faces with a convection_coefficient send: add --picture "
        "elements, which shows the elements' light");
}

}  // namespace

Scene load_scene(const Communicator& world, const Options& options, int threads, const SceneInput& input,
                 Progress* progress) {
  Scene scene;
  on_root(world, [&] {
    scene = build_scene(input, scene_settings(options, threads), progress);
    require_emitter(scene);
    require_convection_known(scene, options.method);
    require_convection_ungathered(scene, options);
  });
  broadcast(world, scene);
  return scene;
}

}  // namespace fluxel

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "scene/cut_patches.hpp"
#include "scene/patch_mesh.hpp"
#include "scene/patch_order.hpp"
#include "scene/scene_input.hpp"
#include "scene/sealed_sides.hpp"
#include "scene/to_patches.hpp"

namespace fluxel {
namespace {

void add_facts(const PatchMesh& mesh, SceneFacts& facts) {
  facts.components = mesh.components.size();
  facts.closed_components = static_cast<std::size_t>(
      std::count_if(mesh.components.begin(), mesh.components.end(), [](const auto& c) { return c.closed; }));
  facts.boundary_edges = mesh.boundary_edges;
  facts.nonmanifold_edges = mesh.nonmanifold_edges;
  facts.flipped_edges = mesh.flipped_edges;
  facts.closed = facts.closed_components == facts.components;
}

}  // namespace

Scene build_scene(const SceneInput& input, const SceneSettings& settings) {
  Scene scene = to_patches(input, settings);
  cut_patches(scene, settings.cut);
  const PatchMesh mesh = connect_patches(scene);
  add_facts(mesh, scene.facts);
  if (settings.sides == Sides::one && mesh.flipped_edges > 0)
    scene.notes.push_back(
        fmt::format("{} {} two patches that face opposite ways (a flipped winding?): in a one-sided scene "
                    "the back of one "
                    "of them is dark",
                    mesh.flipped_edges, mesh.flipped_edges == 1 ? "edge joins" : "edges join"));
  leave_out_sealed_sides(scene, mesh, settings.camera_eye);
  order_pieces(scene);
  return scene;
}

void require_emitter(const Scene& scene) {
  const auto emits = [&](const Patch& patch) { return scene.material(patch).emits(); };
  if (std::none_of(scene.patches.begin(), scene.patches.end(), emits)) {
    throw InputError("no patch emits light (set Ke in the MTL file or E in the scene file)");
  }
}

}  // namespace fluxel

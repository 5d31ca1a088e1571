#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.hpp"
#include "scene/closedness.hpp"
#include "scene/convexity.hpp"
#include "scene/cut_patches.hpp"
#include "scene/merge_patches.hpp"
#include "scene/patch_mesh.hpp"
#include "scene/patch_order.hpp"
#include "scene/polygon.hpp"
#include "scene/receivers_off_surfaces.hpp"
#include "scene/scene_input.hpp"
#include "scene/sealed_sides.hpp"
#include "scene/surface_optics.hpp"
#include "scene/to_patches.hpp"

namespace fluxel {
namespace {

void add_statistics(const PatchMesh& mesh, Scene& scene) {
  SceneStatistics& statistics = scene.statistics;
  statistics.components = mesh.components.size();
  statistics.closed_components = static_cast<std::size_t>(
      std::count_if(mesh.components.begin(), mesh.components.end(), [](const auto& c) { return c.closed; }));
  statistics.boundary_edges = mesh.boundary_edges;
  statistics.nonmanifold_edges = mesh.nonmanifold_edges;
  statistics.flipped_edges = mesh.flipped_edges;
  statistics.closed = is_closed(scene, mesh);
  statistics.lit_inside = is_lit_inside(scene, mesh);
}

/// What a side gets at most where all fluxes into it are as they are given [W/m2]: of air, were it at 0 K.
double most_supplied(const ThermalSurface& surface) {
  return own_exitance(surface) + surface.convection_coefficient * surface.air_temperature;
}

/// In a closed enclosure of given fluxes alone any temperature may be added to all fourth powers, and where
/// more is drawn than emitted some surface would have to be below 0 K.
void require_heat_source(const Scene& scene) {
  double emitted = 0, drawn = 0;
  bool has_temperature = false;
  for (const Piece& piece : scene.pieces) {
    const Patch& patch = scene.patch(piece.patch);
    const Material& material = scene.material(patch);
    const double power =
        area(corners(piece.outline)) * std::popcount(patch.sides) * most_supplied(*material.thermal);
    (power > 0 ? emitted : drawn) += std::abs(power);
    has_temperature =
        has_temperature || material.thermal->temperature.has_value() || material.has_convection();
  }
  if (!has_temperature) {
    throw InputError(
        "no surface has a temperature, and prescribed fluxes alone do not determine any: give at least one "
        "surface a temperature (a black surface at that of the surroundings for an opening) or convection");
  }
  if (emitted == 0) throw InputError("no surface emits heat: all are at 0 K or have a heat_flux of 0");
  if (drawn >= emitted) {
    throw InputError(
        fmt::format("the prescribed fluxes draw {:.6g} W, and no more than {:.6g} W is emitted: there is no "
                    "solution without temperatures below 0 K; check the sign of heat_flux (above 0: into the "
                    "enclosure) or raise a temperature",
                    drawn, emitted));
  }
}

/// What nothing absorbs and nothing lets out grows without end. The backs of one-sided patches absorb, unless
/// they are sealed.
void require_absorber(const Scene& scene) {
  const SceneStatistics& statistics = scene.statistics;
  const bool sealed = statistics.closed_components == statistics.components;
  if (!statistics.closed || !statistics.lit_inside) return;
  for (int c = 0; c < 3; ++c) {
    bool emits = false, absorbs = false;
    for (const Patch& patch : scene.patches) {
      const Material& material = scene.material(patch);
      emits = emits || material.E[c] > 0 || !scene.luminaires.empty();
      absorbs =
          absorbs || material.kept()[c] < 1 - kSharesRounding || (!sealed && patch.sides != (kFront | kBack));
    }
    if (emits && !absorbs)
      throw InputError(
          "nothing absorbs light: the scene is closed and all surfaces send all of it on, so that "
          "light would grow without end; give some surface a Kd below 1, or an opening");
  }
}

}  // namespace

Scene build_scene(const SceneInput& input, const SceneSettings& settings, Progress* progress) {
  Scene scene = to_patches(input, settings);
  // Of the patches as they were read: a merged one meets the short edges of its neighbours with a long one.
  PatchMesh mesh = connect_patches(scene);
  add_statistics(mesh, scene);
  require_clear_bodies(scene, mesh, input);
  if (settings.merge && settings.cut) merge_patches(scene, mesh);
  cut_patches(scene, mesh, settings.cut, settings.threads, progress);
  scene.statistics.convex = is_convex(scene);
  if (scene.statistics.convex)
    scene.notes.emplace_back("convex: no patch stands between two others, no ray is needed");
  if (settings.sides == Sides::one && mesh.flipped_edges > 0)
    scene.notes.push_back(
        fmt::format("{} {} two patches that face opposite ways (a flipped winding?): in a one-sided scene "
                    "the back of one "
                    "of them is dark",
                    mesh.flipped_edges, mesh.flipped_edges == 1 ? "edge joins" : "edges join"));
  scene.receivers = input.receivers;
  for (Receiver& receiver : scene.receivers) {
    receiver.origin -= scene.origin;
    for (glm::dvec3& point : receiver.points) point -= scene.origin;
  }
  move_receivers_off_surfaces(scene);
  if (settings.thermal && !input.luminaires.empty())
    scene.notes.push_back(fmt::format("--thermal: {} luminaires are left out", input.luminaires.size()));
  if (settings.thermal && !(input.observers.empty() && input.tasks.empty()))
    scene.notes.emplace_back("--thermal: observers and tasks are left out");
  if (!settings.thermal) {
    scene.luminaires = input.luminaires;
    scene.intensities = input.intensities;
    for (Luminaire& luminaire : scene.luminaires) luminaire.position -= scene.origin;
    scene.observers = input.observers;
    for (Observer& observer : scene.observers) observer.eye -= scene.origin;
    scene.tasks = input.tasks;
  }
  scene.units = input.units.value_or(Units::radiometric);
  scene.temperature_unit = input.temperature_unit;
  if (settings.seal) leave_out_sealed_sides(scene, mesh, settings.camera_eye);
  order_pieces(scene);
  return scene;
}

void require_emitter(const Scene& scene) {
  if (std::ranges::any_of(scene.materials, [](const Material& m) { return m.thermal.has_value(); })) {
    require_heat_source(scene);
    return;
  }
  const auto emits = [&](const Patch& patch) { return scene.material(patch).emits(); };
  const auto shines = [&](const Luminaire& of) { return flux(scene.intensity(of)) * of.scale != Rgb(0); };
  if (std::ranges::none_of(scene.luminaires, shines) &&
      std::none_of(scene.patches.begin(), scene.patches.end(), emits)) {
    throw InputError(
        scene.lost_emitters.empty()
            ? "nothing emits light (set Ke in the MTL file, E in the scene file, or add [[luminaires]] there)"
            : "no patch emits light: " + scene.lost_emitters);
  }
  require_absorber(scene);
}

}  // namespace fluxel

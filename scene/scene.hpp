#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "core/ids.hpp"
#include "core/material.hpp"
#include "core/units.hpp"
#include "scene/intensity_table.hpp"
#include "scene/lighting_task.hpp"
#include "scene/luminaire.hpp"
#include "scene/observer.hpp"
#include "scene/receiver.hpp"

namespace fluxel {

/// An input polygon, or several merged ones, as it occludes: a triangle or a parallelogram, in recentred
/// metres.
struct Patch {
  Outline<glm::dvec3> outline;
  glm::dvec3 normal{0};  ///< unit, by the right-hand rule over the corners
  double area = 0;       ///< [m2], of the outline, covered parts included
  MaterialId material{};
  GroupId group{};
  std::uint32_t sides = kFront;  ///< mask: the sides that are unknowns; sealed sides are left out
  /// It lies so little in front of an emitter that both count as one plane: of what a ray meets there it goes
  /// before the emitter.
  bool covers_emitter = false;
};

/// A convex part of a patch, the root of a bisection tree: a triangle or a parallelogram in the patch's plane
/// with its orientation. A patch that nothing touches is one piece.
struct Piece {
  Outline<glm::dvec3> outline;
  PatchId patch = kNoPatch;
};

/// What the half-edge structure and the checks say of the patches, for the report. Components and edges are
/// those of the patches as they were read, before any are merged.
struct SceneStatistics {
  std::size_t faces_read = 0;        ///< polygons in the files
  std::size_t degenerate_faces = 0;  ///< dropped
  std::size_t nonplanar_faces = 0;   ///< split along their first diagonal
  std::size_t merged_patches = 0;    ///< taken in by others of their plane: so many fewer than were read
  std::size_t components = 0;        ///< connected sets of patches
  std::size_t closed_components = 0;
  std::size_t boundary_edges = 0;
  std::size_t nonmanifold_edges = 0;
  std::size_t flipped_edges = 0;      ///< edges whose two patches disagree in orientation
  std::size_t coplanar_overlaps = 0;  ///< pairs of patches
  std::size_t cut_patches = 0;        ///< patches of more than one piece
  std::size_t sealed_sides = 0;       ///< sides inside closed components, left out of the unknowns
  double covered_area = 0;            ///< [m2], taken from covered patches
  bool closed = false;                ///< every component is closed or lies within one (see closedness.hpp)
  bool lit_inside = false;            ///< some emitter's front looks into a closed component
  bool convex = false;                ///< no patch can stand between two others (see convexity.hpp)
};

/// Immutable once loaded. Patches keep the order of the input, a merged one at its first part's place; pieces
/// follow a space-filling curve over the patches, all pieces of a patch together: the order of the unknowns.
struct Scene {
  std::string name;
  glm::dvec3 origin{0};  ///< world position of the recentred origin [m]
  double extent = 0;     ///< largest absolute recentred coordinate [m]
  std::vector<Patch> patches;
  std::vector<Piece> pieces;
  std::vector<Material> materials;
  std::vector<std::string> groups;
  std::vector<Receiver> receivers;  ///< recentred
  std::vector<Observer> observers;  ///< recentred
  std::vector<LightingTask> tasks;
  std::vector<Luminaire> luminaires;        ///< recentred
  std::vector<IntensityTable> intensities;  ///< of the luminaires
  Units units = Units::radiometric;
  TemperatureUnit temperature_unit = TemperatureUnit::kelvin;  ///< of what is written; T within is in kelvin
  SceneStatistics statistics;
  std::vector<std::string> notes;     ///< what was found and done, a sentence each
  std::vector<std::string> warnings;  ///< likewise, of what is most likely a mistake and costs light
  std::string lost_emitters;  ///< that emitting faces are too small for this scene; empty where none is

  [[nodiscard]] const Patch& patch(PatchId id) const { return patches[index(id)]; }
  [[nodiscard]] const Material& material(const Patch& patch) const {
    return materials[index(patch.material)];
  }
  [[nodiscard]] const IntensityTable& intensity(const Luminaire& luminaire) const {
    return intensities[luminaire.intensity];
  }
  [[nodiscard]] bool emits(PatchId id) const { return material(patch(id)).emits(); }
};

}  // namespace fluxel

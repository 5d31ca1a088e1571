#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/choices.hpp"
#include "core/material.hpp"
#include "core/units.hpp"
#include "scene/input_camera.hpp"
#include "scene/input_heat.hpp"
#include "scene/scene.hpp"

namespace fluxel {

class Progress;

/// A polygon as a file gives it, in world metres; any number of corners from 3.
struct InputPolygon {
  std::vector<glm::dvec3> corners;
  MaterialId material{};
  GroupId group{};
};

/// A material as a file gives it; `Ke` still has the file's meaning, `E` is an exitance for certain.
struct InputMaterial {
  std::string name;
  Rgb rho{0.5};
  Rgb Ke{0.0};
  std::optional<Rgb> E;         ///< from a scene file, or a format that leaves no doubt: replaces Ke
  std::optional<Sides> sides;   ///< from a scene file: replaces the scene's sidedness
  InputHeat heat{};             ///< for thermal runs, which take it in place of rho and E
  bool textured = false;        ///< rho is the mean of face_rho over its faces, by area
  SurfaceOptics optics{};       ///< from a scene file
  std::size_t optics_line = 0;  ///< of the scene file, where optics stand
  bool is_named_alone = false;  ///< by a shape: a file's values of that name count, else these
};

/// A geometry file, and how its coordinates become metres: metres_per_unit * linear * corner + translate.
struct InputGeometry {
  std::filesystem::path file;
  double metres_per_unit = 1;
  bool unit_given = false;  ///< by the user; else metres are assumed, and doubted (readers/doubtful_unit.hpp)
  glm::dmat3 linear{1};     ///< rotations, scales and mirrors
  glm::dvec3 translate{0};  ///< [m]
};

/// An option that a scene file sets: the name and text that the command line would take.
struct InputOption {
  std::string name;   ///< without dashes, as "max-edge"
  std::string value;  ///< as "0.1"
  std::size_t line = 0;
};

/// What the files say, checked each for itself, before anything is worked out.
struct SceneInput {
  std::string name;  ///< title of the scene file, or the stem of the OBJ
  std::filesystem::path file;
  std::vector<std::filesystem::path> files;  ///< all that were read: geometry and materials too
  std::vector<InputPolygon> polygons;
  std::vector<InputMaterial> materials;
  std::vector<std::string> groups;
  std::vector<Rgb> face_rho;  ///< of each polygon, where textures say one; empty: no file has textures
  std::vector<InputGeometry> geometry;  ///< the files of the polygons, in their order
  std::vector<Receiver> receivers;      ///< world metres
  std::vector<Observer> observers;      ///< world metres
  std::vector<LightingTask> tasks;
  std::vector<Luminaire> luminaires;        ///< world metres
  std::vector<IntensityTable> intensities;  ///< of the luminaires
  std::optional<Units> units;  ///< of what emits; none: the files do not say, which means radiometric
  TemperatureUnit temperature_unit = TemperatureUnit::kelvin;  ///< of what is to be written
  std::vector<InputCamera> cameras;                            ///< of names that differ
  std::vector<InputOption> options;
  std::vector<std::string> notes;
};

/// Reads a scene by its extension: `.toml` (Fluxel's scene file) or geometry (readers/geometry_formats.cpp).
/// `metres_per_unit` is of geometry alone. Throws InputError with file and line.
[[nodiscard]] SceneInput read_scene_input(const std::filesystem::path& file,
                                          std::optional<double> metres_per_unit = std::nullopt);

/// What the scene is made with.
struct SceneSettings {
  Sides sides = Sides::two;
  KeMeaning ke = KeMeaning::exitance;
  bool cut = true;                       ///< cut patches where others touch or cross them
  std::optional<glm::dvec3> camera_eye;  ///< world [m]; a closed component around it is not sealed
  bool thermal = false;                  ///< rho and E from the materials' heat
  bool merge = true;                     ///< merge coplanar patches; never without `cut`
  bool seal = true;                      ///< leave out sides that no light reaches and no camera sees
  int threads = 1;                       ///< that make it; it is the same for every number
  Specular specular = Specular::refuse;
  Textures textures = Textures::mean;  ///< of each material, or materials for large faces that differ from it
};

/// Makes the scene: polygons become triangles and parallelograms, degenerate ones are dropped, coordinates
/// are recentred, coplanar neighbours merged, overlaps and contacts cut, sealed sides found, pieces ordered.
/// Throws InputError where there is nothing to compute (no usable face, or in a thermal run a material in use
/// that says too little), where surfaces that are not diffuse are refused, or bound no clear body though they
/// have an index of refraction (surface_optics.hpp), and where patches cross so often that cutting them has
/// no end (cut_patches.hpp). `progress`, of a phase that has begun, is reported to where cutting takes long.
[[nodiscard]] Scene build_scene(const SceneInput& input, const SceneSettings& settings,
                                Progress* progress = nullptr);

/// Throws InputError where no patch emits light: asked by those who compute light, not by view factors. Of
/// a thermal scene: where no surface has a temperature, or fluxes draw all that is emitted or more.
void require_emitter(const Scene& scene);

}  // namespace fluxel

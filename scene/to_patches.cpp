#include "scene/to_patches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "core/input_error_at.hpp"
#include "scene/face_materials.hpp"
#include "scene/small_faces.hpp"
#include "scene/surface_optics.hpp"
#include "scene/triangulate.hpp"

namespace fluxel {
namespace {

constexpr double kParallelogramTolerance = 1e-6;  // of the longest edge
constexpr double kPlanarTolerance = 1e-4;         // of the longest edge; files round their coordinates
constexpr double kMinArea = 1e-14;                // of the squared diagonal of the bounding box

// Between these, areas and exchange areas keep their digits in single precision.
constexpr double kMaxMetres = 1e9;     // [m]
constexpr double kMinDiagonal = 1e-9;  // [m]

struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

Bounds bounds_of(const SceneInput& input) {
  Bounds bounds;
  for (const InputPolygon& polygon : input.polygons) {
    for (const glm::dvec3& corner : polygon.corners) {
      for (const double value : {corner.x, corner.y, corner.z}) {
        if (std::abs(value) <= kMaxMetres) continue;
        throw input_error_at(input.file, 0, fmt::format("a coordinate of {} m is too large", value),
                             fmt::format("at most {} m; {}", kMaxMetres, ask_for_unit(input)));
      }
      bounds.low = glm::min(bounds.low, corner);
      bounds.high = glm::max(bounds.high, corner);
    }
  }
  return bounds;
}

/// rho and E from the heat; a material that no face uses may have none.
Material to_thermal_material(const InputMaterial& input, Sides sides, bool used,
                             const std::filesystem::path& file) {
  const std::string missing = missing_heat(input.heat);
  if (!missing.empty()) {
    if (!used) return {.name = input.name, .sides = sides};
    throw input_error_at(
        file, 0, fmt::format("material '{}' has no {}", input.name, missing),
        fmt::format(
            "--thermal wants emissivity and temperature [K], or heat_flux [W/m2], or emissivity, "
            "convection_coefficient [W/(m2 K)] and air_temperature [K], of each material in use: statements "
            "in the MTL file, or keys of [materials.{}] in a scene file",
            input.name));
  }
  const ThermalSurface thermal = thermal_surface(input.heat);
  const ThermalExchange exchange = linearised(thermal, first_irradiance(thermal));
  return {
      .name = input.name, .rho = Rgb(exchange.rho), .E = Rgb(exchange.E), .sides = sides, .thermal = thermal};
}

Material to_material(const InputMaterial& input, const SceneSettings& settings) {
  const double exitance_of_Ke = settings.ke == KeMeaning::radiance ? std::numbers::pi : 1.0;
  Material material{.name = input.name,
                    .rho = input.rho,
                    .E = input.E.value_or(input.Ke * exitance_of_Ke),
                    .sides = input.sides.value_or(settings.sides)};
  if (settings.specular == Specular::follow) material.optics = input.optics;
  if (material.optics.bounds_clear_body()) material.sides = Sides::two;
  return material;
}

/// Refuses materials in use that are not diffuse, or counts those that are taken as black.
void settle_specular(const SceneInput& input, const SceneSettings& settings, const std::vector<bool>& used,
                     std::vector<std::string>& notes) {
  if (settings.specular == Specular::follow && !settings.thermal) return;
  std::size_t black = 0;
  for (std::size_t i = 0; i < input.materials.size(); ++i) {
    const InputMaterial& material = input.materials[i];
    if (!used[i] || material.optics == SurfaceOptics{}) continue;
    if (settings.thermal)
      throw input_error_at(input.file, material.optics_line,
                           fmt::format("material '{}' does more than reflect evenly", material.name),
                           "--thermal knows grey diffuse surfaces alone: leave mirror, transmission, "
                           "diffuse_transmission and refraction_index out");
    if (settings.specular == Specular::refuse) refuse_specular(material, input.file);
    ++black;
  }
  if (black > 0)
    notes.push_back(fmt::format("--specular absorb: {} material{} taken as black but for rho", black,
                                black == 1 ? " is" : "s are"));
}

std::vector<Material> to_materials(const SceneInput& input, const SceneSettings& settings,
                                   std::vector<std::string>& notes) {
  std::vector<bool> used(input.materials.size(), false);
  for (const InputPolygon& polygon : input.polygons) used[index(polygon.material)] = true;
  settle_specular(input, settings, used, notes);
  std::vector<Material> materials;
  for (std::size_t i = 0; i < input.materials.size(); ++i) {
    const InputMaterial& material = input.materials[i];
    materials.push_back(
        settings.thermal
            ? to_thermal_material(material, material.sides.value_or(settings.sides), used[i], input.file)
            : to_material(material, settings));
  }
  return materials;
}

/// The corners around `origin`, neighbours that coincide taken once.
std::vector<glm::dvec3> distinct_corners(const InputPolygon& polygon, const glm::dvec3& origin) {
  std::vector<glm::dvec3> corners;
  corners.reserve(polygon.corners.size());
  for (const glm::dvec3& corner : polygon.corners) corners.push_back(corner - origin);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  return corners;
}

double longest_edge(std::span<const glm::dvec3> corners) {
  double longest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    longest = std::max(longest, glm::distance(corners[i], corners[(i + 1) % corners.size()]));
  }
  return longest;
}

bool is_parallelogram(std::span<const glm::dvec3> corners) {
  return corners.size() == 4 && glm::distance(corners[0] + corners[2], corners[1] + corners[3]) <=
                                    kParallelogramTolerance * longest_edge(corners);
}

bool is_planar(std::span<const glm::dvec3> corners, const glm::dvec3& normal) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const glm::dvec3& corner : corners) {
    const double height = glm::dot(corner - corners.front(), normal);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return high - low <= kPlanarTolerance * longest_edge(corners);
}

/// Counts the faces of a kind, and keeps the group of the first.
struct FaceCount {
  std::size_t faces = 0;
  GroupId first{};

  void add(GroupId group) {
    if (faces++ == 0) first = group;
  }

  void note(Scene& scene, const char* what) const {
    if (faces == 0) return;
    scene.notes.push_back(fmt::format("{} face{} {}, first in group '{}'", faces, faces == 1 ? "" : "s", what,
                                      scene.groups[index(first)]));
  }
};

class PatchMaker {
 public:
  PatchMaker(Scene& scene, double least_area) : scene_(scene), least_area_(least_area) {}

  void add(const InputPolygon& polygon, MaterialId material) {
    const std::vector<glm::dvec3> corners = distinct_corners(polygon, scene_.origin);
    const std::size_t before = scene_.patches.size();
    const double area = corners.size() >= 3 ? glm::length(vector_area(corners)) : 0;
    if (area >= least_area_) split(polygon, corners, material);
    if (scene_.patches.size() > before) return;
    ++dropped_;
    const double length = corners.empty() ? 0 : longest_edge(corners);
    if (area > kMinArea * length * length)
      small_.add(polygon.group, scene_.materials[index(material)].emits());
    else
      degenerate_.add(polygon.group);
  }

  void report(const SceneInput& input, double diagonal) const {
    scene_.statistics.degenerate_faces = dropped_;
    scene_.statistics.nonplanar_faces = nonplanar_.faces;
    small_.report(input, diagonal, least_area_, scene_);
    degenerate_.note(scene_, "without an area dropped");
    nonplanar_.note(scene_, "not planar and split into triangles");
    crossing_.note(scene_, "whose outline crosses itself");
  }

 private:
  void split(const InputPolygon& polygon, std::span<const glm::dvec3> corners, MaterialId material) {
    if (corners.size() == 3 || is_parallelogram(corners)) {
      add_patch(polygon, corners, material);
      return;
    }
    const bool planar = is_planar(corners, glm::normalize(vector_area(corners)));
    if (!planar) nonplanar_.add(polygon.group);
    if (!planar && corners.size() == 4) {
      add_patch(polygon, std::array{corners[0], corners[1], corners[2]}, material);
      add_patch(polygon, std::array{corners[0], corners[2], corners[3]}, material);
      return;
    }
    const Triangulation parts = triangulate(corners);
    if (!parts.simple) crossing_.add(polygon.group);
    for (const auto& [a, b, c] : parts.triangles) {
      add_patch(polygon, std::array{corners[a], corners[b], corners[c]}, material);
    }
  }

  void add_patch(const InputPolygon& polygon, std::span<const glm::dvec3> corners, MaterialId material) {
    const glm::dvec3 area = vector_area(corners);
    if (glm::length(area) < least_area_) return;
    Patch& patch = scene_.patches.emplace_back();
    std::copy(corners.begin(), corners.end(), patch.outline.corner.begin());
    patch.outline.corners = static_cast<std::uint32_t>(corners.size());
    patch.area = glm::length(area);
    patch.normal = area / patch.area;
    patch.material = material;
    patch.group = polygon.group;
    patch.sides = scene_.material(patch).sides == Sides::two ? kFront | kBack : kFront;
  }

  Scene& scene_;
  double least_area_;
  FaceCount degenerate_, nonplanar_, crossing_;
  SmallFaces small_;
  std::size_t dropped_ = 0;
};

double extent_of(const Scene& scene) {
  glm::dvec3 extent{0};
  for (const Patch& patch : scene.patches) {
    for (std::uint32_t i = 0; i < patch.outline.corners; ++i) {
      extent = glm::max(extent, glm::abs(patch.outline.corner[i]));
    }
  }
  return std::max({extent.x, extent.y, extent.z});
}

}  // namespace

Scene to_patches(const SceneInput& input, const SceneSettings& settings) {
  Scene scene;
  scene.name = input.name;
  scene.groups = input.groups;
  scene.notes = input.notes;
  scene.materials = to_materials(input, settings, scene.notes);
  scene.statistics.faces_read = input.polygons.size();

  const Bounds bounds = bounds_of(input);
  const double diagonal = glm::distance(bounds.low, bounds.high);
  if (!input.polygons.empty() && diagonal > 0 && diagonal < kMinDiagonal) {
    throw input_error_at(input.file, 0, fmt::format("the whole scene is only {} m across", diagonal),
                         fmt::format("at least {} m; {}", kMinDiagonal, ask_for_unit(input)));
  }
  scene.origin = 0.5 * (bounds.low + bounds.high);

  const bool by_face = settings.textures == Textures::face && !settings.thermal;
  const std::vector<MaterialId> own =
      by_face ? split_by_reflectance(input, scene.materials, scene.notes) : std::vector<MaterialId>{};
  PatchMaker maker(scene, kMinArea * diagonal * diagonal);
  if (diagonal > 0) {
    for (std::size_t k = 0; k < input.polygons.size(); ++k)
      maker.add(input.polygons[k], by_face ? own[k] : input.polygons[k].material);
  }
  if (scene.patches.empty()) {
    throw input_error_at(input.file, 0,
                         fmt::format("holds no face with an area, of {} read", input.polygons.size()));
  }
  maker.report(input, diagonal);
  scene.extent = extent_of(scene);
  return scene;
}

}  // namespace fluxel

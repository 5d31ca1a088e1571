#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <string>
#include <vector>

#include "scene/polygon.hpp"
#include "scene/scene.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::by_hand {

inline constexpr MaterialId kWhite{0};
inline constexpr MaterialId kLight{1};

/// A scene without patches: a white and an emitting material of the given sidedness.
inline Scene empty_scene(Sides sides) {
  Scene scene;
  scene.materials = {{"white", Rgb{0.5}, Rgb{0.0}, sides}, {"light", Rgb{0.0}, Rgb{1.0}, sides}};
  return scene;
}

/// Adds a triangle or parallelogram in a group of that name.
inline PatchId add(Scene& scene, const std::string& group, const std::vector<glm::dvec3>& corner,
                   MaterialId material = kWhite) {
  Patch patch;
  std::copy(corner.begin(), corner.end(), patch.outline.corner.begin());
  patch.outline.corners = static_cast<std::uint32_t>(corner.size());
  patch.area = area(corner);
  patch.normal = area_vector(corner) / patch.area;
  patch.material = material;
  patch.group = GroupId{static_cast<std::uint32_t>(scene.groups.size())};
  patch.sides = scene.material(patch).sides == Sides::two ? kFront | kBack : kFront;
  scene.groups.push_back(group);
  scene.patches.push_back(patch);
  return PatchId{static_cast<std::uint32_t>(scene.patches.size() - 1)};
}

/// Adds the six faces of a box, with normals outward or inward; the first is its bottom, z = low.z.
inline PatchId add_box(Scene& scene, const std::string& group, const glm::dvec3& low, const glm::dvec3& high,
                       bool outward, MaterialId material = kWhite) {
  const PatchId first{static_cast<std::uint32_t>(scene.patches.size())};
  const std::vector<closed_forms::Polygon> faces = closed_forms::box(low, high);
  for (const closed_forms::Polygon& face : outward ? faces : closed_forms::reversed(faces))
    add(scene, group, face, material);
  return first;
}

inline std::vector<Outline<glm::dvec3>> pieces_of(const Scene& scene, PatchId patch) {
  std::vector<Outline<glm::dvec3>> pieces;
  for (const Piece& piece : scene.pieces) {
    if (piece.patch == patch) pieces.push_back(piece.outline);
  }
  return pieces;
}

inline double piece_area(const Scene& scene, PatchId patch) {
  double sum = 0;
  for (const auto& outline : pieces_of(scene, patch)) sum += area(corners(outline));
  return sum;
}

/// Uniform over all rotations (Shoemake 1992).
inline glm::dquat random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(glm::dquat(w, x, y, z));
}

inline void rotate(Scene& scene, const glm::dquat& rotation) {
  for (Patch& patch : scene.patches) {
    for (glm::dvec3& x : patch.outline.corner) x = rotation * x;
    patch.normal = rotation * patch.normal;
  }
}

}  // namespace fluxel::by_hand

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene_input.hpp"

namespace fluxel {

/// Joins what several geometry files say: groups of one name are one group, materials of one name are one
/// material.
class GeometryMerger {
 public:
  /// `scene` takes what is added and outlives the merger.
  explicit GeometryMerger(SceneInput& scene) : scene_(scene) {}

  /// Adds what a file has, placed as `geometry` says. Throws InputError where a material has
  /// other values than the one of that name in an earlier file.
  void add(SceneInput part, const InputGeometry& geometry);

 private:
  MaterialId merge(InputMaterial material, const std::filesystem::path& file);
  GroupId merge(std::string group);
  /// `materials` of the scene, of those of the part.
  void merge_face_rho(const SceneInput& part, const std::vector<MaterialId>& materials);

  SceneInput& scene_;
  std::map<std::string, std::pair<MaterialId, std::filesystem::path>> materials_;
  std::map<std::string, GroupId> groups_;
};

}  // namespace fluxel

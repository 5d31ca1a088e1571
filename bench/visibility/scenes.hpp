#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/element.hpp"
#include "scene/scene.hpp"

namespace fluxel::bench {

/// A scene of the benchmark and where it comes from.
struct SceneSource {
  std::string name;
  std::filesystem::path file;
  std::vector<std::string> options;  ///< of `fluxel solve`, beside --sides one
};

/// The project's own scenes, then those that `large_scenes` may hold, whether they are there or not.
[[nodiscard]] std::vector<SceneSource> scene_sources(const std::filesystem::path& large_scenes);

struct LoadedScene {
  Scene scene;
  std::optional<Camera> camera;
};

/// As `fluxel solve FILE --sides one` loads it; with `triangles` all polygons are cut into triangles first,
/// so that no patch is a parallelogram. Throws InputError.
[[nodiscard]] LoadedScene load_scene(const SceneSource& source, bool triangles);

/// Uniform subdivision by the longest edge, which is bisected until the number of elements is as near to
/// `wanted` as one edge length for all can bring it; never fewer than there are pieces.
[[nodiscard]] ElementMesh subdivide_to_size(const Scene& scene, std::size_t wanted);

/// The classical method's scene: the elements' own outlines are the patches.
[[nodiscard]] Scene scene_of_elements(const Scene& scene, const ElementMesh& mesh);

}  // namespace fluxel::bench

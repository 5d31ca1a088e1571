#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "core/camera.hpp"
#include "scene/scene_input.hpp"

namespace CLI {
class App;
}

namespace fluxel {

/// A camera as options give it, one by one.
struct CameraParts {
  std::optional<std::string> name;  ///< of a camera of the scene, or of a JSON file that holds one
  std::optional<glm::dvec3> eye, look_at, up;
  std::optional<double> fov;             ///< vertical, full angle [degrees]
  std::optional<glm::ivec2> resolution;  ///< width and height [pixels]
};

/// A camera as a file gives it.
struct CameraOfFile {
  InputCamera camera;
  std::filesystem::path file;
};

/// The scene's camera of that name, or that of the JSON file of that name; without a name the scene's first,
/// empty where it has none. Throws InputError where there is no such camera, with those that there are.
[[nodiscard]] CameraOfFile camera_of_file(const SceneInput& input, const std::optional<std::string>& name);

/// The options and what they leave of the file's camera together, with the up direction scaled to a moderate
/// length, or none where neither eye nor look-at is given. Throws InputError for half a camera, and for
/// values that are out of range or contradict each other, also where there is none: with file and line where
/// the file says what is wrong and `command` did not.
[[nodiscard]] std::optional<Camera> choose_camera(const CameraParts& parts, const SceneInput& input,
                                                  const CLI::App& command);

}  // namespace fluxel

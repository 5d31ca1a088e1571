#include "app/choose_camera.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "app/camera_file.hpp"
#include "core/input_error_at.hpp"
#include "scene/list_names.hpp"

namespace fluxel {

namespace {

double largest_component(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The direction by a power of two, which rounds nothing, so that its square is a number.
glm::dvec3 of_moderate_length(const glm::dvec3& direction) {
  const double largest = largest_component(direction);
  if (largest == 0) return direction;
  const int exponent = std::ilogb(largest);
  return {std::ldexp(direction.x, -exponent), std::ldexp(direction.y, -exponent),
          std::ldexp(direction.z, -exponent)};
}

/// What the options leave open is the file's.
CameraParts completed(CameraParts parts, const InputCamera& camera) {
  const auto take = [](auto& part, const auto& of_file) {
    if (!part && of_file) part = of_file->value;
  };
  take(parts.name, camera.name);
  take(parts.eye, camera.eye);
  take(parts.look_at, camera.look_at);
  take(parts.up, camera.up);
  take(parts.fov, camera.fov);
  take(parts.resolution, camera.resolution);
  return parts;
}

std::optional<Camera> finished_camera(const CameraParts& parts) {
  constexpr double kFarthest = 1e100;  // [m]; the square of much more is no number
  Camera camera;
  camera.name = parts.name.value_or("");
  camera.fov = parts.fov.value_or(camera.fov);
  if (!(camera.fov > 0 && camera.fov < 180)) throw InputError("--fov must be between 0 and 180 degrees");
  camera.up = of_moderate_length(parts.up.value_or(camera.up));
  if (largest_component(camera.up) == 0) throw InputError("--up is zero");
  if (parts.resolution) {
    camera.width = parts.resolution->x;
    camera.height = parts.resolution->y;
  }
  if (!parts.eye && !parts.look_at) return std::nullopt;
  if (!parts.eye || !parts.look_at) throw InputError("a camera needs both --eye and --look-at");
  camera.eye = *parts.eye;
  camera.look_at = *parts.look_at;
  for (const auto& [name, place] : {std::pair("--eye", camera.eye), std::pair("--look-at", camera.look_at)})
    if (largest_component(place) > kFarthest)
      throw InputError(fmt::format("{} is too far away: coordinates go up to 1e100 m", name));
  const glm::dvec3 view = camera.look_at - camera.eye;
  if (glm::length(view) == 0) throw InputError("--eye and --look-at are the same point");
  if (glm::length(glm::cross(view, camera.up)) <= 1e-9 * glm::length(view) * glm::length(camera.up))
    throw InputError("--up is parallel to the view from --eye to --look-at");
  return camera;
}

}  // namespace

CameraOfFile camera_of_file(const SceneInput& input, const std::optional<std::string>& name) {
  const std::vector<InputCamera>& cameras = input.cameras;
  if (!name) return {cameras.empty() ? InputCamera{} : cameras.front(), input.file};
  if (is_camera_file(*name)) return {read_camera_file(*name), *name};
  std::vector<std::string> names;
  for (const InputCamera& camera : cameras) {
    if (!camera.name) continue;
    if (camera.name->value == *name) return {camera, input.file};
    names.push_back(camera.name->value);
  }
  if (names.empty())
    throw InputError(
        fmt::format("--camera {}: {} has no camera with a name; give it one in [[camera]] of a scene "
                    "file, name a file (--camera FILE.json), or say where it is by --eye and --look-at",
                    *name, input.file.string()));
  throw InputError(fmt::format("--camera {}: {} has no such camera; {}", *name, input.file.string(),
                               known_names(*name, names)));
}

std::optional<Camera> choose_camera(const CameraParts& parts, const SceneInput& input,
                                    const CLI::App& command) {
  const CameraOfFile of_file = camera_of_file(input, parts.name);
  try {
    return finished_camera(completed(parts, of_file.camera));
  } catch (const InputError& error) {
    const std::string what = error.what();
    std::optional<std::size_t> line;
    for (const std::string name : {"fov", "up", "look-at", "eye"}) {
      if (what.find("--" + name) == std::string::npos) continue;
      if (command.count("--" + name) > 0) throw;
      if (!line) line = of_file.camera.line_of(name);
    }
    if (line) throw input_error_at(of_file.file, *line, "camera: " + what);
    throw;
  }
}

}  // namespace fluxel

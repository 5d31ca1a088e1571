#pragma once

#include <filesystem>
#include <string>

#include "scene/input_camera.hpp"

namespace fluxel {

/// Whether the value of --camera is a file's name, by its extension .json, and not a camera's.
[[nodiscard]] bool is_camera_file(const std::filesystem::path& name);

/// Reads a camera from a JSON file: an object with keys of [camera] of a scene file (eye, look_at, up, fov,
/// resolution), each with its line. Throws InputError with file, line and key.
[[nodiscard]] InputCamera read_camera_file(const std::filesystem::path& file);

/// The same of a text; `file` stands in messages.
[[nodiscard]] InputCamera read_camera_text(const std::filesystem::path& file, const std::string& text);

}  // namespace fluxel

#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/options.hpp"
#include "scene/readers/scene_file.hpp"

namespace fluxel::test_scene_text {

using Files = std::map<std::string, std::string>;

inline const std::string kBox =
    "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "g floor\nusemtl white\nf 1 2 3 4\ng lamp\nusemtl light\nf 1 2 4\n";
inline const std::string kBoxMaterials = "newmtl white\nKd 0.5 0.5 0.5\nnewmtl light\nKd 0 0 0\nKe 1 2 3\n";
inline const Files kFiles = {{"dir/box.obj", kBox}, {"dir/box.mtl", kBoxMaterials}};
inline const std::string kGeometry = "[[geometry]]\nfile = \"box.obj\"\n";

/// A scene file of that text beside those files.
inline SceneInput read(const std::string& text, const Files& files = kFiles) {
  return read_scene_text("dir/scene.toml", text, [&](const std::filesystem::path& path) {
    const auto found = files.find(path.string());
    return found == files.end() ? std::nullopt : std::optional(found->second);
  });
}

/// What is said of it.
inline std::string error_of(const std::string& text, const Files& files = kFiles) {
  try {
    static_cast<void>(read(text, files));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace fluxel::test_scene_text

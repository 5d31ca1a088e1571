#include <optional>
#include <string>

#include "core/error.hpp"
#include "scene/readers/geometry_formats.hpp"
#include "scene/readers/scene_file.hpp"
#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

SceneInput read_scene_input(const std::filesystem::path& file) {
  const std::optional<std::string> bytes = read_text_file(file);
  if (!bytes) throw input_error_at(file, 0, "there is no such file");
  if (lower_extension(file) == ".toml") return read_scene_text(file, *bytes, read_text_file);
  if (const GeometryFormat* const format = geometry_format(file)) {
    return format->read(file, *bytes, read_text_file);
  }
  throw input_error_at(file, 0, "this is no scene file", "known: .toml and " + geometry_extensions());
}

}  // namespace fluxel

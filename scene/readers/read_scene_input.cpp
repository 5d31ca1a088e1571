#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/input_error_at.hpp"
#include "scene/readers/geometry_formats.hpp"
#include "scene/readers/placing.hpp"
#include "scene/readers/scene_file.hpp"
#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

SceneInput read_scene_input(const std::filesystem::path& file, std::optional<double> metres_per_unit) {
  const std::optional<std::string> bytes = read_text_file(file);
  if (!bytes) throw input_error_at(file, 0, "there is no such file");
  const bool is_scene_file = lower_extension(file) == ".toml";
  const GeometryFormat* const format = geometry_format(file);
  if (!is_scene_file && format == nullptr)
    throw input_error_at(file, 0, "this is no scene file", "known: .toml and " + geometry_extensions());
  if (is_scene_file && metres_per_unit)
    throw input_error_at(file, 0, "--metres-per-unit is of geometry files alone",
                         "write metres_per_unit into [[geometry]] of the scene file");

  std::vector<std::filesystem::path> files{file};
  const TextLookup lookup = [&files](const std::filesystem::path& named) {
    files.push_back(named);
    return read_text_file(named);
  };
  SceneInput input =
      is_scene_file ? read_scene_text(file, *bytes, lookup) : format->read(file, *bytes, lookup);
  input.files = std::move(files);
  if (metres_per_unit) {
    input.geometry = {{.file = file, .metres_per_unit = *metres_per_unit, .unit_given = true}};
    place(input, input.geometry.front());
  }
  return input;
}

}  // namespace fluxel

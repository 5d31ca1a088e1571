#include "scene/readers/camera_table.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace fluxel {
namespace {

glm::ivec2 read_resolution(const TomlFile& toml, const toml::node& node) {
  constexpr std::int64_t kMaxPixels = 65536;  // a side, as of --resolution
  glm::ivec2 pixels{};
  const toml::array& values = toml.array(node, "camera resolution", 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::int64_t value = values[i].is_integer() ? values[i].as_integer()->get() : 0;
    if (value <= 0) throw toml.error(node.source(), "camera resolution must be two whole numbers above 0");
    if (value > kMaxPixels)
      throw toml.error(node.source(), fmt::format("camera resolution: {} pixels are too many", value),
                       fmt::format("1 to {} pixels a side", kMaxPixels));
    pixels[static_cast<int>(i)] = static_cast<int>(value);
  }
  return pixels;
}

InputCamera read_camera(const TomlFile& toml, const toml::node& node, const std::string& where) {
  const toml::table& table = toml.table(node, where);
  toml.require_known_keys(table, where, {"name", "eye", "look_at", "up", "fov", "resolution"});
  InputCamera camera;
  for (const auto& [key, value] : table) {
    const std::string name = fmt::format("camera {}", key.str());
    const std::size_t line = key.source().begin.line;
    if (key.str() == "name") {
      camera.name = {toml.text(value, name), line};
      if (camera.name->value.empty()) throw toml.error(value.source(), "camera name is empty");
    } else if (key.str() == "resolution") {
      camera.resolution = {read_resolution(toml, value), line};
    } else if (key.str() == "fov") {
      camera.fov = {toml.number(value, name), line};
    } else {
      auto& vector = key.str() == "eye" ? camera.eye : key.str() == "up" ? camera.up : camera.look_at;
      vector = {toml.vector(value, name), line};
    }
  }
  return camera;
}

}  // namespace

std::vector<InputCamera> read_cameras(const TomlFile& toml, const toml::node& node) {
  if (!node.is_array()) return {read_camera(toml, node, "[camera]")};
  std::vector<InputCamera> cameras;
  for (const toml::node& of_array : *node.as_array()) {
    InputCamera camera = read_camera(toml, of_array, "[[camera]]");
    if (!camera.name)
      throw toml.error(of_array.source(), "[[camera]] lacks name", "a single camera may stand as [camera]");
    const auto same = std::ranges::find_if(
        cameras, [&](const InputCamera& other) { return other.name->value == camera.name->value; });
    if (same != cameras.end())
      throw toml.error(of_array.as_table()->get("name")->source(),
                       fmt::format("a second camera '{}'", camera.name->value),
                       fmt::format("first in line {}", same->name->line));
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace fluxel

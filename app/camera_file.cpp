#include "app/camera_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/input_error_at.hpp"
#include "scene/list_names.hpp"
#include "scene/readers/geometry_formats.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

namespace {

using nlohmann::json;

constexpr std::size_t kMaxBytes = 1 << 16;  // a camera has some hundred
constexpr std::int64_t kMaxPixels = 65536;  // a side, as of --resolution
const std::vector<std::string> kKeys{"eye", "look_at", "up", "fov", "resolution"};

std::size_t line_at(std::string_view text, std::size_t byte) {
  return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, byte), '\n'));
}

/// Of each key, where it first stands: JSON itself keeps no lines.
std::size_t line_of_key(std::string_view text, const std::string& key) {
  const std::size_t at = text.find('"' + key + '"');
  return at == std::string_view::npos ? 0 : line_at(text, at);
}

class CameraObject {
 public:
  CameraObject(const std::filesystem::path& file, const std::string& text) : file_(file), text_(text) {
    if (text.size() > kMaxBytes)
      throw input_error_at(file, 0, fmt::format("{} bytes are too many for a camera", text.size()),
                           fmt::format("at most {}", kMaxBytes));
    try {
      std::set<std::string> keys;
      object_ = json::parse(text, [&](int depth, json::parse_event_t event, const json& parsed) {
        if (event != json::parse_event_t::key || depth != 1) return true;
        if (keys.insert(parsed.get<std::string>()).second) return true;
        throw error(parsed.get<std::string>(),
                    fmt::format("camera {} is given twice", parsed.get<std::string>()));
      });
    } catch (const json::parse_error& error) {
      throw input_error_at(file, line_at(text, error.byte), "this is no JSON", "a camera is " + shape());
    } catch (const json::exception&) {  // as of a number beyond all doubles
      throw input_error_at(file, 0, "a number is out of range");
    }
    if (!object_.is_object())
      throw input_error_at(file, 1, "this is no JSON object", "a camera is " + shape());
    for (const auto& [key, value] : object_.items())
      if (std::ranges::find(kKeys, key) == kKeys.end())
        throw error(key, fmt::format("unknown key '{}' of a camera", key), known_names(key, kKeys));
  }

  [[nodiscard]] std::optional<FileValue<double>> number(const std::string& key) const {
    return read<double>(key, [&](const json& value) { return number_of(key, value); });
  }

  [[nodiscard]] std::optional<FileValue<glm::dvec3>> vector(const std::string& key) const {
    return read<glm::dvec3>(key, [&](const json& value) {
      require_array(key, value, 3);
      return glm::dvec3(number_of(key, value[0]), number_of(key, value[1]), number_of(key, value[2]));
    });
  }

  [[nodiscard]] std::optional<FileValue<glm::ivec2>> resolution(const std::string& key) const {
    return read<glm::ivec2>(key, [&](const json& value) {
      require_array(key, value, 2);
      glm::ivec2 pixels;
      for (int i = 0; i < 2; ++i) {
        const double side = number_of(key, value[static_cast<std::size_t>(i)]);
        if (!(side >= 1 && side <= kMaxPixels && side == std::floor(side)))
          throw error(key, fmt::format("camera {} must be two whole numbers from 1 to {}", key, kMaxPixels));
        pixels[i] = static_cast<int>(side);
      }
      return pixels;
    });
  }

 private:
  static std::string shape() { return R"({"eye": [x, y, z], "look_at": [x, y, z], ...})"; }

  [[nodiscard]] InputError error(const std::string& key, const std::string& what,
                                 const std::string& hint = {}) const {
    return input_error_at(file_, line_of_key(text_, key), what, hint);
  }

  template <class Value, class Read>
  [[nodiscard]] std::optional<FileValue<Value>> read(const std::string& key, const Read& read) const {
    const auto found = object_.find(key);
    if (found == object_.end()) return std::nullopt;
    return FileValue<Value>{read(*found), line_of_key(text_, key)};
  }

  [[nodiscard]] double number_of(const std::string& key, const json& value) const {
    if (!value.is_number()) throw error(key, fmt::format("camera {} must have numbers", key));
    return value.get<double>();
  }

  void require_array(const std::string& key, const json& value, std::size_t size) const {
    if (!value.is_array() || value.size() != size)
      throw error(key, fmt::format("camera {} must be an array of {} numbers", key, size));
  }

  const std::filesystem::path& file_;
  const std::string& text_;
  json object_;
};

}  // namespace

bool is_camera_file(const std::filesystem::path& name) { return lower_extension(name) == ".json"; }

InputCamera read_camera_file(const std::filesystem::path& file) {
  const std::optional<std::string> text = read_text_file(file);
  if (!text) throw input_error_at(file, 0, "there is no such file", "--camera FILE.json, or a camera's name");
  return read_camera_text(file, *text);
}

InputCamera read_camera_text(const std::filesystem::path& file, const std::string& text) {
  const CameraObject object(file, text);
  InputCamera camera;
  camera.eye = object.vector("eye");
  camera.look_at = object.vector("look_at");
  camera.up = object.vector("up");
  camera.fov = object.number("fov");
  camera.resolution = object.resolution("resolution");
  return camera;
}

}  // namespace fluxel

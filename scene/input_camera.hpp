#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace fluxel {

/// A value of a file, and the line where it stands (0: the format has no lines).
template <class Value>
struct FileValue {
  Value value{};
  std::size_t line = 0;
};

/// A camera of a file, as far as it gives one; in world metres and degrees.
struct InputCamera {
  std::optional<FileValue<std::string>> name;
  std::optional<FileValue<glm::dvec3>> eye, look_at, up;
  std::optional<FileValue<double>> fov;             ///< vertical, full angle [degrees]
  std::optional<FileValue<glm::ivec2>> resolution;  ///< width and height [pixels]

  /// The line of what the command line takes as --OPTION, or none where the file does not give it.
  [[nodiscard]] std::optional<std::size_t> line_of(std::string_view option) const {
    const auto line = [](const auto& given) { return given ? std::optional(given->line) : std::nullopt; };
    return option == "eye"          ? line(eye)
           : option == "look-at"    ? line(look_at)
           : option == "up"         ? line(up)
           : option == "fov"        ? line(fov)
           : option == "resolution" ? line(resolution)
                                    : std::nullopt;
  }
};

}  // namespace fluxel

#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/options.hpp"
#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel::test_readers {

/// What a reader of one file, that names no other, makes of these bytes.
template <class Reader>
SceneInput read_bytes(Reader read, const char* file, const std::string& bytes) {
  return read(file, bytes, [](const std::filesystem::path&) { return std::optional<std::string>(); });
}

/// Its message, or `no error`.
template <class Reader>
std::string error_of(Reader read, const char* file, const std::string& bytes) {
  try {
    static_cast<void>(read_bytes(read, file, bytes));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Area times unit normal of a plane polygon: the front is where the corners run counterclockwise.
inline glm::dvec3 area_vector(const InputPolygon& polygon) {
  glm::dvec3 sum(0);
  const std::size_t corners = polygon.corners.size();
  for (std::size_t i = 0; i < corners; ++i)
    sum += glm::cross(polygon.corners[i] - polygon.corners[0],
                      polygon.corners[(i + 1) % corners] - polygon.corners[0]);
  return sum / 2.0;
}

inline double area_of(const SceneInput& scene) {
  double area = 0;
  for (const InputPolygon& polygon : scene.polygons) area += glm::length(area_vector(polygon));
  return area;
}

}  // namespace fluxel::test_readers

#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/options.hpp"

namespace fluxel {

/// A camera takes shape option by option, from the scene file and the command line.
struct CameraParts {
  std::optional<glm::dvec3> eye, look_at;
  Camera rest;
};

/// The camera with its up direction scaled to a moderate length, or none where neither eye nor look-at is
/// given. Throws InputError for half a camera, and for values that are out of range or contradict each other,
/// also where there is none.
[[nodiscard]] std::optional<Camera> finished_camera(const CameraParts& parts);

/// Throws InputError for contradictions and values out of range, before any work.
void check_options(const Options& options);

/// Throws InputError where options, without dashes, belong to other methods, and names all of them and those.
void check_known(const std::vector<std::string>& given, Method method);

/// As check_options, of a reference.
void check_reference_options(const ReferenceOptions& options);

}  // namespace fluxel

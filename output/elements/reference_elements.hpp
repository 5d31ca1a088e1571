#pragma once

#include <filesystem>
#include <vector>

#include "output/elements/element_file.hpp"
#include "reference/sensors.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Elements of a file as places to measure. Throws InputError where there are none or they are not of this
/// scene: a patch that it does not have, an element off its patch's plane or beyond its edges, backs in one
/// of both alone.
[[nodiscard]] std::vector<ElementShape> shapes_on_scene(const std::filesystem::path& file,
                                                        const ElementFile& read, const Scene& scene);

}  // namespace fluxel

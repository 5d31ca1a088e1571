#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "core/surface_light.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Writes the solution as a file of elements (scene/element_file.hpp) with the layer kRadiosity and, where
/// there are back unknowns, kRadiosityBack, and a colour of each element; `comment` is a line of the header.
/// Throws as write_element_file does.
void write_solution(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                    const SurfaceLight& light, std::span<const std::uint8_t> rgb = {},
                    const std::string& comment = {});

/// The same with parallelograms as two triangles each, which have the radiosity and colour of their element.
void write_triangles(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                     const SurfaceLight& light, std::span<const std::uint8_t> rgb,
                     const std::string& comment);

/// The radiosities of such a file, fronts, then (in two-sided scenes) backs; a reference holds them too.
/// Throws InputError where it cannot be read, is of other elements, or holds what is not finite; the version
/// that wrote it does not matter.
[[nodiscard]] std::vector<Rgb> read_solution(const std::filesystem::path& file, const Scene& scene,
                                             const ElementView& mesh, bool two_sided);

}  // namespace fluxel

#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/element.hpp"
#include "core/rgb.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Names of the layers of a solution: radiosity [W/m2] of the fronts and, in two-sided scenes, of the backs.
inline constexpr const char* kRadiosity = "radiosity";
inline constexpr const char* kRadiosityBack = "radiosity_back";

/// The elements of a file of elements, in the order of the unknowns.
struct FileElements {
  std::vector<Outline<glm::dvec3>> outlines;  ///< world metres
  std::vector<PatchId> patches;
};

/// What stands at the elements under one name, in three colours.
struct ElementLayer {
  std::string name;
  std::span<const Rgb> values;
};

/// A file of elements as it is read.
struct ElementFile {
  FileElements elements;
  std::map<std::string, std::vector<Rgb>, std::less<>> layers;
};

/// A mesh of the scene as a file holds it.
[[nodiscard]] FileElements file_elements(const Scene& scene, const ElementView& mesh);

/// Writes binary little-endian PLY (Turk 1994): a face for each element, in their order, with the properties
/// `float NAME_r, NAME_g, NAME_b` for each layer and `uint patch`. Vertices are in world metres, in double
/// precision: far from the world's origin single precision would move them. With `rgb`, three an element,
/// faces have a colour too, `uchar red, green, blue`, as programs that show PLY files take it; it is not read
/// again, and neither is the `comment`, a line of the header. Corners at equal coordinates are one vertex,
/// except those of a face that would make the mesh non-manifold: it has its own. The file depends on the
/// arguments and the program's version alone; what has been read is written again with the same vertices.
/// Throws InputError where the file cannot be written (nothing then stands under its name), std::logic_error
/// where a value is not finite in single precision or a layer has not one value an element.
void write_element_file(const std::filesystem::path& file, const FileElements& elements,
                        std::span<const ElementLayer> layers, std::span<const std::uint8_t> rgb = {},
                        const std::string& comment = {});

/// Writes the elements likewise with a colour each and one value, `float NAME`. `comment` is a line of the
/// header.
void write_coloured_elements(const std::filesystem::path& file, const FileElements& elements,
                             std::span<const std::uint8_t> rgb, const std::string& name,
                             std::span<const double> values, const std::string& comment);

/// Reads a file of write_element_file, of whatever version. Throws InputError, with the line of the header or
/// the byte, for what is damaged, holds values that are not finite or that Fluxel has not written.
[[nodiscard]] ElementFile read_element_file(const std::filesystem::path& file);

/// The same from the file's bytes.
[[nodiscard]] ElementFile element_file_of_bytes(const std::filesystem::path& file, std::string_view bytes);

}  // namespace fluxel

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>

#include "core/file.hpp"
#include "core/version.hpp"
#include "output/elements/element_file.hpp"
#include "output/elements/element_file_header.hpp"
#include "output/elements/indexed_mesh.hpp"

namespace fluxel {

namespace {

template <class T>
void append(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little, "the file is little endian");
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// The bytes of a file whose faces have these properties, which `append_face` appends for a face by number.
std::string ply_bytes(const FileElements& elements, std::string_view comments,
                      const std::string& face_properties,
                      const std::function<void(std::string&, std::size_t)>& append_face) {
  const IndexedMesh mesh = indexed_mesh(elements.outlines);
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\n{}{}\n{}\n"
      "{}{}\nproperty double x\nproperty double y\nproperty double z\n"
      "{}{}\n{}\n{}end_header\n",
      kPlyVersionComment, version(), comments, kPlyVertices, mesh.vertices.size(), kPlyFaces,
      mesh.faces.size(), kPlyCorners, face_properties);
  for (const glm::dvec3& vertex : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) append(bytes, vertex[axis]);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const IndexedMesh::Face& face = mesh.faces[i];
    append(bytes, static_cast<std::uint8_t>(face.corners));
    for (std::size_t k = 0; k < face.corners; ++k) append(bytes, face.vertex[k]);
    append_face(bytes, i);
  }
  return bytes;
}

void require_one_each(const FileElements& elements, const std::string& name, std::size_t values) {
  const std::size_t count = elements.outlines.size();
  if (elements.patches.size() != count || values != count)
    throw std::logic_error(
        fmt::format("file of elements: {} elements, but {} values of {}", count, values, name));
}

void require_finite(const std::string& name, std::size_t element, double value) {
  if (!(std::abs(value) <= std::numeric_limits<float>::max()))
    throw std::logic_error(
        fmt::format("file of elements: the {} of element {} is not finite", name, element));
}

}  // namespace

FileElements file_elements(const Scene& scene, const ElementView& mesh) {
  FileElements elements;
  elements.outlines.reserve(mesh.outlines.size());
  elements.patches.reserve(mesh.elements.size());
  for (const Outline<glm::vec3>& outline : mesh.outlines) {
    elements.outlines.push_back(widen(outline));
    for (glm::dvec3& corner : elements.outlines.back().corner) corner += scene.origin;
  }
  for (const Element& element : mesh.elements) elements.patches.push_back(element.patch);
  return elements;
}

void write_element_file(const std::filesystem::path& file, const FileElements& elements,
                        std::span<const ElementLayer> layers, std::span<const std::uint8_t> rgb,
                        const std::string& comment) {
  std::string properties;
  if (!rgb.empty()) {
    require_one_each(elements, "colour", rgb.size() / kChannels);
    properties += kPlyRgb;
  }
  for (const ElementLayer& layer : layers) {
    require_one_each(elements, layer.name, layer.values.size());
    for (std::size_t i = 0; i < layer.values.size(); ++i)
      for (int c = 0; c < kChannels; ++c) require_finite(layer.name, i, layer.values[i][c]);
    for (const std::string_view colour : kPlyColours)
      properties += fmt::format("{}{}{}\n", kPlyFloat, layer.name, colour);
  }
  properties += fmt::format("{}\n", kPlyPatch);
  std::string comments(kPlyUnits);
  if (!comment.empty()) comments += "\ncomment " + comment;
  write_bytes_atomically(file,
                         ply_bytes(elements, comments, properties, [&](std::string& bytes, std::size_t i) {
                           if (!rgb.empty())
                             for (const std::uint8_t colour : rgb.subspan(kChannels * i, kChannels))
                               append(bytes, colour);
                           for (const ElementLayer& layer : layers)
                             for (int c = 0; c < kChannels; ++c)
                               append(bytes, static_cast<float>(layer.values[i][c]));
                           append(bytes, static_cast<std::uint32_t>(elements.patches[i]));
                         }));
}

void write_coloured_elements(const std::filesystem::path& file, const FileElements& elements,
                             std::span<const std::uint8_t> rgb, const std::string& name,
                             std::span<const double> values, const std::string& comment) {
  require_one_each(elements, name, values.size());
  require_one_each(elements, "colour", rgb.size() / kChannels);
  for (std::size_t i = 0; i < values.size(); ++i) require_finite(name, i, values[i]);
  const std::string properties = fmt::format("{}{}{}\n{}\n", kPlyRgb, kPlyFloat, name, kPlyPatch);
  write_bytes_atomically(
      file, ply_bytes(elements, "comment " + comment, properties, [&](std::string& bytes, std::size_t i) {
        for (const std::uint8_t colour : rgb.subspan(kChannels * i, kChannels)) append(bytes, colour);
        append(bytes, static_cast<float>(values[i]));
        append(bytes, static_cast<std::uint32_t>(elements.patches[i]));
      }));
}

}  // namespace fluxel

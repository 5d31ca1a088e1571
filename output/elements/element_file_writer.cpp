#include <fmt/format.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/version.hpp"
#include "output/elements/element_file.hpp"
#include "output/elements/element_file_header.hpp"

namespace fluxel {

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using HalfEdgeMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;
using Vertex = HalfEdgeMesh::VertexHandle;

/// OpenMesh names a face that it refuses on the error stream; here that is no error.
class QuietOpenMesh {
 public:
  QuietOpenMesh() { omerr().disable(); }
  ~QuietOpenMesh() { omerr().enable(); }
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;
};

struct HashCorner {
  std::size_t operator()(const glm::dvec3& corner) const {
    const glm::dvec3 unsigned_zero = corner + 0.0;  // equal corners must hash alike, and -0 equals 0
    return hash_bytes(std::as_bytes(std::span(&unsigned_zero, 1)));
  }
};

HalfEdgeMesh make_half_edge_mesh(std::span<const Outline<glm::dvec3>> outlines) {
  const QuietOpenMesh quiet;
  HalfEdgeMesh result;
  result.reserve(outlines.size(), 2 * outlines.size(), outlines.size());
  const auto add_vertex = [&](const glm::dvec3& corner) {
    return result.add_vertex({corner.x, corner.y, corner.z});
  };
  std::unordered_map<glm::dvec3, Vertex, HashCorner> welded;
  std::vector<Vertex> face;
  for (const auto& outline : outlines) {
    const std::span corners(outline.corner.data(), outline.corners);
    face.clear();
    bool distinct = true;
    for (const glm::dvec3& corner : corners) {
      const auto [at, is_new] = welded.try_emplace(corner);
      if (is_new) at->second = add_vertex(corner);
      distinct = distinct && std::find(face.begin(), face.end(), at->second) == face.end();
      face.push_back(at->second);
    }
    if (distinct && result.add_face(face).is_valid()) continue;
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (!distinct || !result.is_isolated(face[i])) face[i] = add_vertex(corners[i]);
    }
    result.add_face(face);
  }
  return result;
}

template <class T>
void append(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little, "the file is little endian");
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// The bytes of a file whose faces have these properties, which `append_face` appends for a face by number.
std::string ply_bytes(const FileElements& elements, std::string_view comment,
                      const std::string& face_properties,
                      const std::function<void(std::string&, std::size_t)>& append_face) {
  const HalfEdgeMesh mesh = make_half_edge_mesh(elements.outlines);
  // OpenMesh's own PLY writer knows neither comments nor coordinates in double precision.
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\n{}{}\n{}\n"
      "{}{}\nproperty double x\nproperty double y\nproperty double z\n"
      "{}{}\n{}\n{}end_header\n",
      kPlyVersionComment, version(), comment, kPlyVertices, mesh.n_vertices(), kPlyFaces, mesh.n_faces(),
      kPlyCorners, face_properties);
  for (const auto vertex : mesh.vertices()) {
    for (const double coordinate : mesh.point(vertex)) append(bytes, coordinate);
  }
  for (const auto face : mesh.faces()) {
    append(bytes, static_cast<std::uint8_t>(mesh.valence(face)));
    for (const auto vertex : face.vertices()) append(bytes, static_cast<std::uint32_t>(vertex.idx()));
    append_face(bytes, static_cast<std::size_t>(face.idx()));
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
                        std::span<const ElementLayer> layers) {
  std::string properties;
  for (const ElementLayer& layer : layers) {
    require_one_each(elements, layer.name, layer.values.size());
    for (std::size_t i = 0; i < layer.values.size(); ++i)
      for (int c = 0; c < kChannels; ++c) require_finite(layer.name, i, layer.values[i][c]);
    for (const std::string_view colour : kPlyColours)
      properties += fmt::format("{}{}{}\n", kPlyFloat, layer.name, colour);
  }
  properties += fmt::format("{}\n", kPlyPatch);
  write_bytes_atomically(file,
                         ply_bytes(elements, kPlyUnits, properties, [&](std::string& bytes, std::size_t i) {
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
  const std::string properties = "property uchar red\nproperty uchar green\nproperty uchar blue\n" +
                                 fmt::format("{}{}\n{}\n", kPlyFloat, name, kPlyPatch);
  write_bytes_atomically(
      file, ply_bytes(elements, "comment " + comment, properties, [&](std::string& bytes, std::size_t i) {
        for (const std::uint8_t colour : rgb.subspan(kChannels * i, kChannels)) append(bytes, colour);
        append(bytes, static_cast<float>(values[i]));
        append(bytes, static_cast<std::uint32_t>(elements.patches[i]));
      }));
}

}  // namespace fluxel

#include "scene/solution_writer.hpp"

#include <fmt/format.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/version.hpp"
#include "scene/text_file.hpp"

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
  std::size_t operator()(const glm::vec3& corner) const {
    const glm::vec3 unsigned_zero = corner + 0.0f;  // equal corners must hash alike, and -0 equals 0
    return hash_bytes(std::as_bytes(std::span(&unsigned_zero, 1)));
  }
};

HalfEdgeMesh make_half_edge_mesh(const Scene& scene, const ElementView& mesh) {
  const QuietOpenMesh quiet;
  HalfEdgeMesh result;
  result.reserve(mesh.outlines.size(), 2 * mesh.outlines.size(), mesh.outlines.size());
  const auto add_vertex = [&](const glm::vec3& corner) {
    const glm::dvec3 world = scene.origin + glm::dvec3(corner);
    return result.add_vertex({world.x, world.y, world.z});
  };
  std::unordered_map<glm::vec3, Vertex, HashCorner> welded;
  std::vector<Vertex> face;
  for (const auto& outline : mesh.outlines) {
    const std::span corners(outline.corner.data(), outline.corners);
    face.clear();
    bool distinct = true;
    for (const glm::vec3& corner : corners) {
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

void require_writable_light(const ElementView& mesh, const SurfaceLight& light) {
  const std::size_t elements = mesh.elements.size();
  if (mesh.outlines.size() != elements || light.B_front.size() != elements ||
      (!light.B_back.empty() && light.B_back.size() != elements)) {
    throw std::logic_error("write_solution: elements and radiosities do not fit each other");
  }
  for (const auto* side : {&light.B_front, &light.B_back}) {
    for (std::size_t i = 0; i < side->size(); ++i) {
      for (int c = 0; c < kChannels; ++c) {
        if (std::abs((*side)[i][c]) <= std::numeric_limits<float>::max()) continue;
        throw std::logic_error(fmt::format("write_solution: the radiosity of element {} is not finite", i));
      }
    }
  }
}

constexpr const char* kMagic = "ply\nformat binary_little_endian 1.0\ncomment Fluxel ";

std::string ply_header(const HalfEdgeMesh& mesh, bool with_back) {
  std::string header = fmt::format(
      "{}{}\n"
      "comment radiosity in W/m2 (or lm/m2, as the scene's emission), lengths in m\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list uchar uint vertex_indices\n"
      "property float radiosity_r\nproperty float radiosity_g\nproperty float radiosity_b\n",
      kMagic, version(), mesh.n_vertices(), mesh.n_faces());
  if (with_back) {
    header +=
        "property float radiosity_back_r\nproperty float radiosity_back_g\n"
        "property float radiosity_back_b\n";
  }
  return header + "property uint patch\nend_header\n";
}

template <class T>
void append(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little, "the file is little endian");
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

void append_radiosity(std::string& bytes, const Rgb& B) {
  for (int c = 0; c < kChannels; ++c) append(bytes, static_cast<float>(B[c]));
}

std::string solution_bytes(const Scene& scene, const ElementView& mesh, const SurfaceLight& light) {
  const HalfEdgeMesh half_edges = make_half_edge_mesh(scene, mesh);
  // OpenMesh's own PLY writer knows neither comments nor coordinates in double precision.
  std::string bytes = ply_header(half_edges, !light.B_back.empty());
  for (const auto vertex : half_edges.vertices()) {
    for (const double coordinate : half_edges.point(vertex)) append(bytes, coordinate);
  }
  for (const auto face : half_edges.faces()) {
    const auto i = static_cast<std::size_t>(face.idx());
    append(bytes, static_cast<std::uint8_t>(half_edges.valence(face)));
    for (const auto vertex : face.vertices()) append(bytes, static_cast<std::uint32_t>(vertex.idx()));
    append_radiosity(bytes, light.B_front[i]);
    if (!light.B_back.empty()) append_radiosity(bytes, light.B_back[i]);
    append(bytes, static_cast<std::uint32_t>(mesh.elements[i].patch));
  }
  return bytes;
}

/// Where the header's second line of comment begins: what stands before may be of another version.
std::size_t after_version(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) return 0;
  const std::size_t end = bytes.find('\n', std::string_view(kMagic).size());
  return end == std::string_view::npos ? 0 : end + 1;
}

constexpr const char* kRightSolution =
    "give the solution.ply of a run with the same geometry, camera and subdivision; lights, reflectances and "
    "solver may differ";

/// Takes a face's radiosity out of the bytes, leaving 0.
Rgb take_radiosity(std::span<char> bytes) {
  Rgb B;
  for (int c = 0; c < kChannels; ++c) {
    float value;
    std::memcpy(&value, bytes.data() + static_cast<std::size_t>(c) * sizeof value, sizeof value);
    B[c] = static_cast<double>(value);
  }
  std::ranges::fill(bytes.first(kChannels * sizeof(float)), '\0');
  return B;
}

}  // namespace

void write_solution(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                    const SurfaceLight& light) {
  require_writable_light(mesh, light);
  write_bytes_atomically(file, solution_bytes(scene, mesh, light));
}

std::vector<Rgb> read_solution(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                               bool two_sided) {
  std::optional<std::string> bytes = read_text_file(file);
  if (!bytes) throw input_error_at(file, 0, "cannot be read", kRightSolution);
  return solution_of_bytes(file, std::move(*bytes), scene, mesh, two_sided);
}

std::vector<Rgb> solution_of_bytes(const std::filesystem::path& file, std::string bytes, const Scene& scene,
                                   const ElementView& mesh, bool two_sided) {
  const auto refuse = [&](const char* what) { throw input_error_at(file, 0, what, kRightSolution); };
  const std::size_t elements = mesh.elements.size();
  const std::vector<Rgb> dark(elements, Rgb(0));
  // What a solution of these elements looks like without its light.
  const std::string expected =
      solution_bytes(scene, mesh, {dark, two_sided ? dark : std::vector<Rgb>{}, {}, {}});
  const std::size_t start = after_version(bytes), expected_start = after_version(expected);
  if (start == 0) refuse("is no solution that Fluxel has written");
  if (bytes.size() - start != expected.size() - expected_start) refuse("is a solution of other elements");

  const std::size_t sides = two_sided ? 2 : 1;
  std::vector<Rgb> B(sides * elements);
  // Faces stand at the end, so they are found from there.
  std::size_t faces = bytes.size();
  const auto bytes_of = [&](std::size_t i) {
    return 1 + 4 * std::size_t{mesh.outlines[i].corners} + sides * kChannels * sizeof(float) + 4;
  };
  for (std::size_t i = 0; i < elements; ++i) faces -= bytes_of(i);
  for (std::size_t i = 0; i < elements; faces += bytes_of(i), ++i)
    for (std::size_t side = 0; side < sides; ++side) {
      const std::size_t at = faces + 1 + 4 * std::size_t{mesh.outlines[i].corners};
      B[side * elements + i] =
          take_radiosity(std::span(bytes).subspan(at + side * kChannels * sizeof(float)));
    }
  if (std::string_view(bytes).substr(start) != std::string_view(expected).substr(expected_start))
    refuse("is a solution of other elements");
  if (!std::ranges::all_of(B, [](const Rgb& of) { return std::isfinite(of.r + of.g + of.b); }))
    refuse("has radiosities that are not finite");
  return B;
}

}  // namespace fluxel

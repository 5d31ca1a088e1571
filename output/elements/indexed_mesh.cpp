#include "output/elements/indexed_mesh.hpp"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <unordered_map>

#include "core/hash.hpp"

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

}  // namespace

IndexedMesh indexed_mesh(std::span<const Outline<glm::dvec3>> outlines) {
  const HalfEdgeMesh mesh = make_half_edge_mesh(outlines);
  IndexedMesh indexed;
  indexed.vertices.reserve(mesh.n_vertices());
  for (const auto vertex : mesh.vertices()) {
    const OpenMesh::Vec3d& at = mesh.point(vertex);
    indexed.vertices.emplace_back(at[0], at[1], at[2]);
  }
  indexed.faces.reserve(mesh.n_faces());
  for (const auto face : mesh.faces()) {
    IndexedMesh::Face& made = indexed.faces.emplace_back();
    for (const auto vertex : face.vertices())
      made.vertex[made.corners++] = static_cast<std::uint32_t>(vertex.idx());
  }
  return indexed;
}

}  // namespace fluxel

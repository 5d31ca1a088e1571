#include "method/mesh_points.hpp"

#include <cstddef>
#include <span>
#include <unordered_map>

#include "core/hash.hpp"
#include "subdivision/piece_finder.hpp"

namespace fluxel {

namespace {

/// Of the way from a vertex to the middle of its elements: a few centimetres of a face of half a metre, and
/// of an inner vertex, whose elements lie around it, almost nothing.
constexpr double kTowardsMiddle = 0.1;

struct VertexKey {
  NodeId face = kNoNode;
  glm::vec3 position{0};

  bool operator==(const VertexKey&) const = default;
};

struct HashVertex {
  std::size_t operator()(const VertexKey& key) const {
    const glm::vec3 unsigned_zero = key.position + 0.0F;  // equal positions must hash alike
    return hash_bytes(std::as_bytes(std::span(&unsigned_zero, 1)),
                      hash_bytes(std::as_bytes(std::span(&key.face, 1))));
  }
};

}  // namespace

std::vector<NodeId> faces_of_unknowns(const NodeTree& tree, const ElementView& mesh) {
  const PieceFinder finder(tree.scene());
  const std::size_t count = mesh.elements.size();
  std::vector<NodeId> faces(2 * count, kNoNode);
  for (std::size_t k = 0; k < count; ++k) {
    const Element& element = mesh.elements[k];
    const std::size_t piece = finder.find(element.patch, glm::dvec3(element.centroid));
    if ((element.sides & kFront) != 0) faces[k] = tree.face(piece, true);
    if ((element.sides & kBack) != 0) faces[count + k] = tree.face(piece, false);
  }
  return faces;
}

MeshVertices vertices_of(const ElementView& mesh, const std::vector<NodeId>& faces) {
  MeshVertices found;
  found.corners.resize(faces.size());
  std::unordered_map<VertexKey, std::uint32_t, HashVertex> numbers;
  std::vector<glm::dvec3> middles;  // sums over the elements around each
  std::vector<std::uint32_t> around;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    if (faces[k] == kNoNode) continue;
    const std::size_t element = k % mesh.elements.size();
    const Outline<glm::vec3>& outline = mesh.outlines[element];
    for (std::size_t c = 0; c < outline.corners; ++c) {
      const auto [entry, is_new] = numbers.try_emplace({faces[k], outline.corner[c]},
                                                       static_cast<std::uint32_t>(found.positions.size()));
      const std::uint32_t vertex = found.corners[k][c] = entry->second;
      if (is_new) {
        found.positions.push_back(outline.corner[c]);
        found.points.push_back({faces[k], glm::dvec3(outline.corner[c])});
        middles.emplace_back(0);
        around.push_back(0);
      }
      middles[vertex] += glm::dvec3(mesh.elements[element].centroid);
      ++around[vertex];
    }
  }
  for (std::size_t v = 0; v < found.points.size(); ++v) {
    glm::dvec3& at = found.points[v].position;
    at += kTowardsMiddle * (middles[v] / static_cast<double>(around[v]) - at);
  }
  return found;
}

}  // namespace fluxel

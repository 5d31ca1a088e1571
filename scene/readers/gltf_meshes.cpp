#include "scene/readers/gltf_meshes.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>

namespace fluxel {
namespace {

constexpr std::size_t kCopiedTriangles = 2'000'000;  // that small files may make by copies of their meshes

std::string path_of(std::size_t mesh, std::size_t primitive) {
  return fmt::format("meshes[{}].primitives[{}]", mesh, primitive);
}

/// The vertices of a primitive in the order that its mode goes by.
struct Sequence {
  GltfAccessor positions;
  std::optional<GltfAccessor> indices;
  int mode;

  [[nodiscard]] std::size_t size() const { return indices ? indices->size() : positions.size(); }
  [[nodiscard]] std::size_t triangles() const {
    if (mode == TINYGLTF_MODE_TRIANGLES) return size() / 3;
    return size() < 3 ? 0 : size() - 2;
  }
  /// Places in the sequence: glTF 2.0, section 3.7.2.1.
  [[nodiscard]] std::array<std::size_t, 3> triangle(std::size_t t) const {
    if (mode == TINYGLTF_MODE_TRIANGLES) return {3 * t, 3 * t + 1, 3 * t + 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {t + 1, t + 2, 0};
    return {t, t + 1 + t % 2, t + 2 - t % 2};
  }
};

bool is_triangles(const tinygltf::Primitive& primitive) { return primitive.mode >= TINYGLTF_MODE_TRIANGLES; }

Sequence read_sequence(const GltfFile& gltf, const tinygltf::Primitive& primitive, const std::string& where) {
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) throw gltf.error(where, "has no POSITION");
  Sequence sequence{GltfAccessor(gltf, static_cast<std::size_t>(position->second), 3), {}, primitive.mode};
  if (primitive.indices >= 0) {
    const auto accessor = static_cast<std::size_t>(primitive.indices);
    sequence.indices.emplace(gltf, accessor, 1);
    if (!sequence.indices->is_index())
      throw gltf.error(gltf_element("accessors", accessor), "indices must be of type 5121, 5123 or 5125");
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && sequence.size() % 3 != 0)
    throw gltf.error(where, fmt::format("{} vertices do not make triangles", sequence.size()));
  return sequence;
}

GltfTriangles read_triangles(const GltfFile& gltf, std::size_t mesh, std::size_t k) {
  const tinygltf::Primitive& primitive = gltf.model->meshes[mesh].primitives[k];
  const std::string where = path_of(mesh, k);
  const Sequence sequence = read_sequence(gltf, primitive, where);
  GltfTriangles triangles{mesh, k, std::nullopt, sequence.positions, {}, {}};
  if (primitive.material >= 0) triangles.material = static_cast<std::size_t>(primitive.material);
  triangles.corners.reserve(sequence.triangles());
  for (std::size_t t = 0; t < sequence.triangles(); ++t) {
    std::array<std::size_t, 3> corners = sequence.triangle(t);
    for (std::size_t& corner : corners) {
      if (sequence.indices) corner = static_cast<std::size_t>((*sequence.indices)[corner].x);
      if (corner >= sequence.positions.size()) {
        throw gltf.error(gltf_element("accessors", static_cast<std::size_t>(primitive.indices)),
                         fmt::format("index {} is out of range", corner),
                         fmt::format("{} has {} vertices", where, sequence.positions.size()));
      }
    }
    // Strips turn corners by vertices that stand twice.
    const bool joint = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    if (!joint || primitive.mode == TINYGLTF_MODE_TRIANGLES) triangles.corners.push_back(corners);
  }
  return triangles;
}

/// How many triangles one node with the mesh has, if no more than `most`; before any is made, since counts
/// may be vast.
std::size_t count_triangles(const GltfFile& gltf, std::size_t mesh, std::size_t most) {
  std::size_t count = 0;
  const std::vector<tinygltf::Primitive>& primitives = gltf.model->meshes[mesh].primitives;
  for (std::size_t k = 0; k < primitives.size(); ++k) {
    if (is_triangles(primitives[k]))
      count += std::min(read_sequence(gltf, primitives[k], path_of(mesh, k)).triangles(), most + 1);
  }
  return count;
}

}  // namespace

std::string GltfTriangles::where() const { return path_of(mesh, primitive); }

GltfMeshes read_gltf_meshes(const GltfFile& gltf, const std::vector<GltfNode>& nodes,
                            std::size_t file_bytes) {
  GltfMeshes read;
  read.meshes.resize(gltf.model->meshes.size());
  read.copies.resize(read.meshes.size());
  std::vector<std::optional<std::size_t>> counts(read.meshes.size());
  const std::size_t most = kCopiedTriangles + file_bytes;  // a triangle of its own takes a byte and more
  for (const GltfNode& node : nodes) {
    const int given = gltf.model->nodes[node.node].mesh;
    if (given < 0) continue;
    const auto mesh = static_cast<std::size_t>(given);
    if (!counts[mesh]) counts[mesh] = count_triangles(gltf, mesh, most);
    if (*counts[mesh] > most - read.triangles) {
      throw gltf.error(gltf_element("nodes", node.node), fmt::format("makes more than {} triangles", most),
                       "the meshes are used too often for the size of the file");
    }
    read.triangles += *counts[mesh];
    ++read.copies[mesh];
  }
  for (std::size_t mesh = 0; mesh < read.meshes.size(); ++mesh) {
    if (!counts[mesh]) continue;
    for (std::size_t k = 0; k < gltf.model->meshes[mesh].primitives.size(); ++k) {
      if (is_triangles(gltf.model->meshes[mesh].primitives[k])) {
        read.meshes[mesh].push_back(read_triangles(gltf, mesh, k));
      } else {
        ++read.points_and_lines;
      }
    }
  }
  return read;
}

}  // namespace fluxel

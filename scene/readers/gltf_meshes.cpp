#include "scene/readers/gltf_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fluxel {
namespace {

constexpr std::size_t kCopiedTriangles = 2'000'000;  // that small files may make by copies of their meshes

constexpr std::size_t kTriangles = 4, kTriangleFan = 6;  // modes, as numbers of OpenGL; strips are 5

std::string path_of(std::size_t mesh, std::size_t primitive) {
  return fmt::format("meshes[{}].primitives[{}]", mesh, primitive);
}

/// The vertices of a primitive in the order that its mode goes by.
struct PrimitiveSequence {
  GltfAccessor positions;
  std::optional<GltfAccessor> indices;
  std::size_t mode;

  [[nodiscard]] std::size_t size() const { return indices ? indices->size() : positions.size(); }
  [[nodiscard]] std::size_t triangles() const {
    if (mode == kTriangles) return size() / 3;
    return size() < 3 ? 0 : size() - 2;
  }
  /// Places in the sequence: glTF 2.0, section 3.7.2.1.
  [[nodiscard]] std::array<std::size_t, 3> triangle(std::size_t t) const {
    if (mode == kTriangles) return {3 * t, 3 * t + 1, 3 * t + 2};
    if (mode == kTriangleFan) return {t + 1, t + 2, 0};
    return {t, t + 1 + t % 2, t + 2 - t % 2};
  }
};

std::size_t mode_of(const GltfValue& primitive) { return primitive["mode"].whole(kTriangles); }

bool is_triangles(const GltfValue& primitive) { return mode_of(primitive) >= kTriangles; }

GltfValue primitives_of(const GltfFile& gltf, std::size_t mesh) { return gltf["meshes"][mesh]["primitives"]; }

PrimitiveSequence read_sequence(const GltfFile& gltf, const GltfValue& primitive, const std::string& where) {
  const GltfValue position = primitive["attributes"]["POSITION"], indices = primitive["indices"];
  if (!position.given()) throw gltf.error(where, "has no POSITION");
  PrimitiveSequence sequence{GltfAccessor(gltf, position.whole(), 3), {}, mode_of(primitive)};
  if (indices.given()) {
    const std::size_t accessor = indices.whole();
    sequence.indices.emplace(gltf, accessor, 1);
    if (!sequence.indices->is_index())
      throw gltf.error(gltf_element("accessors", accessor), "indices must be of type 5121, 5123 or 5125");
  }
  if (sequence.mode == kTriangles && sequence.size() % 3 != 0)
    throw gltf.error(where, fmt::format("{} vertices do not make triangles", sequence.size()));
  return sequence;
}

GltfTriangles read_triangles(const GltfFile& gltf, std::size_t mesh, std::size_t k) {
  const GltfValue primitive = primitives_of(gltf, mesh)[k], material = primitive["material"];
  const std::string where = path_of(mesh, k);
  const PrimitiveSequence sequence = read_sequence(gltf, primitive, where);
  GltfTriangles triangles{mesh, k, std::nullopt, sequence.positions, {}, {}};
  if (material.given()) triangles.material = material.whole();
  triangles.corners.reserve(sequence.triangles());
  for (std::size_t t = 0; t < sequence.triangles(); ++t) {
    std::array<std::size_t, 3> corners = sequence.triangle(t);
    for (std::size_t& corner : corners) {
      if (sequence.indices) corner = static_cast<std::size_t>((*sequence.indices)[corner].x);
      if (corner >= sequence.positions.size()) {
        throw gltf.error(gltf_element("accessors", primitive["indices"].whole()),
                         fmt::format("index {} is out of range", corner),
                         fmt::format("{} has {} vertices", where, sequence.positions.size()));
      }
    }
    // Strips turn corners by vertices that stand twice.
    const bool joint = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    if (!joint || sequence.mode == kTriangles) triangles.corners.push_back(corners);
  }
  return triangles;
}

/// How many triangles one node with the mesh has, if no more than `most`; before any is made, since counts
/// may be vast.
std::size_t count_triangles(const GltfFile& gltf, std::size_t mesh, std::size_t most) {
  std::size_t count = 0;
  const GltfValue primitives = primitives_of(gltf, mesh);
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
  read.meshes.resize(gltf["meshes"].size());
  read.copies.resize(read.meshes.size());
  std::vector<std::optional<std::size_t>> counts(read.meshes.size());
  const std::size_t most = kCopiedTriangles + file_bytes;  // a triangle of its own takes a byte and more
  for (const GltfNode& node : nodes) {
    const GltfValue given = gltf["nodes"][node.node]["mesh"];
    if (!given.given()) continue;
    const std::size_t mesh = given.whole();
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
    const GltfValue primitives = primitives_of(gltf, mesh);
    for (std::size_t k = 0; k < primitives.size(); ++k) {
      if (is_triangles(primitives[k])) {
        read.meshes[mesh].push_back(read_triangles(gltf, mesh, k));
      } else {
        ++read.points_and_lines;
      }
    }
  }
  return read;
}

}  // namespace fluxel

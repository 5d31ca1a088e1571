#include "scene/readers/gltf_nodes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <optional>

namespace fluxel {
namespace {

constexpr double kMaxTransform = 1e15;  // as a coordinate of an OBJ file

using Parents = std::vector<std::optional<std::size_t>>;

/// Columns of the matrix, or translation * rotation * scale (glTF 2.0, section 3.5.3).
glm::dmat4 local_transform(const GltfFile& gltf, std::size_t k) {
  const GltfValue node = gltf["nodes"][k], matrix = node["matrix"];
  glm::dmat4 transform(1);
  if (matrix.given()) {
    for (int i = 0; i < 16; ++i) transform[i / 4][i % 4] = matrix[static_cast<std::size_t>(i)].number(0);
    for (int column = 0; column < 4; ++column) {
      if (std::abs(transform[column][3] - (column == 3 ? 1 : 0)) > 1e-6)
        throw gltf.error(gltf_element("nodes", k) + ".matrix", "is not affine",
                         "its last row must be 0 0 0 1");
      transform[column][3] = column == 3 ? 1 : 0;
    }
    return transform;
  }
  const auto xyzw = node["rotation"].vector(glm::dvec4(0, 0, 0, 1));
  const glm::dquat rotation(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
  if (!(glm::length(rotation) > 1e-6)) throw gltf.error(gltf_element("nodes", k) + ".rotation", "is zero");
  const glm::dmat3 turn = glm::mat3_cast(glm::normalize(rotation));
  const auto scale = node["scale"].vector(glm::dvec3(1));
  for (int axis = 0; axis < 3; ++axis) transform[axis] = glm::dvec4(turn[axis] * scale[axis], 0);
  transform[3] = glm::dvec4(node["translation"].vector(glm::dvec3(0)), 1);
  return transform;
}

Parents find_parents(const GltfFile& gltf) {
  const GltfValue nodes = gltf["nodes"];
  Parents parents(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const GltfValue children = nodes[k]["children"];
    for (std::size_t i = 0; i < children.size(); ++i) {
      const std::size_t child = children[i].whole();
      if (parents[child]) {
        throw gltf.error(gltf_element("nodes", child),
                         fmt::format("is a child of nodes[{}] and of nodes[{}]", *parents[child], k),
                         "a node has one parent");
      }
      parents[child] = k;
    }
  }
  return parents;
}

std::vector<std::size_t> find_roots(const GltfFile& gltf, const Parents& parents) {
  std::vector<std::size_t> roots;
  if (gltf["scenes"].size() == 0) {
    for (std::size_t k = 0; k < parents.size(); ++k) {
      if (!parents[k]) roots.push_back(k);
    }
    return roots;
  }
  const std::size_t scene = gltf["scene"].whole();
  const GltfValue nodes = gltf["scenes"][scene]["nodes"];
  std::vector<bool> named(parents.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::size_t root = nodes[k].whole();
    const std::string where = gltf_element("scenes", scene) + ".nodes";
    if (named[root]) throw gltf.error(where, fmt::format("names nodes[{}] twice", root));
    if (parents[root])
      throw gltf.error(where, fmt::format("nodes[{}] is a child of nodes[{}]", root, *parents[root]),
                       "a scene names roots");
    named[root] = true;
    roots.push_back(root);
  }
  return roots;
}

/// Follows each node to its root: one that goes on for more steps than there are nodes, goes round.
void require_no_cycle(const GltfFile& gltf, const Parents& parents) {
  std::vector<bool> has_root(parents.size());
  std::vector<std::size_t> path;
  for (std::size_t k = 0; k < parents.size(); ++k) {
    path.clear();
    std::optional<std::size_t> node = k;
    for (; node && !has_root[*node]; node = parents[*node]) {
      path.push_back(*node);
      if (path.size() > parents.size()) throw gltf.error(gltf_element("nodes", *node), "is its own ancestor");
    }
    for (const std::size_t passed : path) has_root[passed] = true;
  }
}

/// A product of bounded transforms may be anything.
void require_bounded(const GltfFile& gltf, const GltfNode& node) {
  for (int i = 0; i < 16; ++i) {
    if (!(std::abs(node.to_world[i / 4][i % 4]) <= kMaxTransform)) {
      throw gltf.error(gltf_element("nodes", node.node),
                       "its transform, with those of its parents, is too large",
                       fmt::format("at most {}", kMaxTransform));
    }
  }
}

}  // namespace

std::vector<GltfNode> place_gltf_nodes(const GltfFile& gltf) {
  const Parents parents = find_parents(gltf);
  require_no_cycle(gltf, parents);
  // A stack in place of recursion: trees may be as deep as there are nodes.
  std::vector<GltfNode> placed, open;
  const std::vector<std::size_t> roots = find_roots(gltf, parents);
  for (std::size_t k = roots.size(); k-- > 0;) open.push_back({roots[k]});
  while (!open.empty()) {
    GltfNode node = open.back();
    open.pop_back();
    node.to_world = node.to_world * local_transform(gltf, node.node);
    require_bounded(gltf, node);
    const GltfValue children = gltf["nodes"][node.node]["children"];
    for (std::size_t k = children.size(); k-- > 0;) open.push_back({children[k].whole(), node.to_world});
    placed.push_back(node);
  }
  return placed;
}

glm::dvec3 node_direction(const GltfFile& gltf, const GltfNode& node, const glm::dvec3& axis) {
  const glm::dvec3 direction = glm::dmat3(node.to_world) * axis;
  const double length = glm::length(direction);
  if (!(length > 0 && std::isfinite(length)))
    throw gltf.error(gltf_element("nodes", node.node), "its scale leaves a camera or a light no direction");
  return direction / length;
}

}  // namespace fluxel

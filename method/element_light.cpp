#include "method/element_light.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "subdivision/piece_finder.hpp"

namespace fluxel {

void take_leaves(const Communicator& world, const NodeTree& tree, std::span<const GatherPoint> points,
                 SubdividedScene& subdivided) {
  ElementMesh mesh;
  if (world.is_root()) mesh = tree.elements();
  share_elements(world, mesh, subdivided);
  const std::vector<ElementNodes> nodes = tree.element_nodes();
  std::vector<std::uint32_t> element_of(tree.size());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (const NodeId side : {nodes[k].front, nodes[k].back})
      if (side != kNoNode) element_of[side] = static_cast<std::uint32_t>(k);
  for (std::size_t pixel = 0; pixel < points.size(); ++pixel)
    if (const NodeId leaf = tree.leaf_below(points[pixel].face, points[pixel].position); leaf != kNoNode)
      subdivided.raster.element[pixel] = ElementId{element_of[leaf]};
}

namespace {

/// Parts of the length of an element and of its area by which single precision moves it.
constexpr double kSamePlace = 1e-3;

/// The node that is the element, of a tree that halves the same piece; or none: the tree may be coarser
/// there, or have cut across the other side first.
NodeId node_of_element(const NodeTree& tree, NodeId face, const glm::dvec3& centroid, double area) {
  NodeId id = face;
  while (tree[id].shape.area > (1 + kSamePlace) * area && !tree[id].is_leaf())
    id = tree[id].child[tree.in_first_child(id, centroid) ? 0 : 1];
  const FlatShape& shape = tree[id].shape;
  const bool is_same = std::abs(shape.area - area) <= kSamePlace * area &&
                       glm::distance(shape.centroid, centroid) <= kSamePlace * std::sqrt(area);
  return is_same ? id : kNoNode;
}

/// Where the light of an element is gathered: the centroids of its quarters.
std::array<glm::dvec3, 4> middles_of_quarters(const Outline<glm::dvec3>& outline) {
  const auto& [a, b, c, d] = outline.corner;
  const glm::dvec3 middle = (a + b + c) / 3.0;
  if (outline.corners == 3) return {middle, 0.5 * (middle + a), 0.5 * (middle + b), 0.5 * (middle + c)};
  const glm::dvec3 u = 0.25 * (b - a), v = 0.25 * (d - a);
  return {a + u + v, b - u + v, c - u - v, d + u - v};
}

}  // namespace

Radiosity light_of_elements(Hierarchy& hierarchy, const ElementView& mesh, const GatherGoal& goal,
                            Progress& progress) {
  const NodeTree& tree = hierarchy.tree();
  const Scene& scene = tree.scene();
  Radiosity light = hierarchy.radiosity();
  const std::vector<Rgb> H = hierarchy.irradiance_of_nodes();
  const Unknowns unknowns = make_unknowns(mesh.elements, scene.materials);
  light.B.assign(unknowns.size(), Rgb(0));
  light.H.assign(unknowns.size(), Rgb(0));
  std::vector<GatherPoint> points;
  std::vector<std::size_t> of_point;
  const PieceFinder finder(scene);
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    if (!(unknowns.area[k] > 0)) continue;
    const Element& element = mesh.elements[k % mesh.elements.size()];
    const glm::dvec3 centroid(element.centroid);
    const NodeId face = tree.face(finder.find(element.patch, centroid), k < mesh.elements.size());
    if (const NodeId id = node_of_element(tree, face, centroid, unknowns.area[k]); id != kNoNode) {
      light.H[k] = H[id];
      continue;
    }
    const Outline<glm::dvec3> outline = widen(mesh.outlines[k % mesh.elements.size()]);
    for (const glm::dvec3& middle : middles_of_quarters(outline)) {
      points.push_back({face, middle});
      of_point.push_back(k);
    }
  }
  progress.begin("gathering for elements");
  const std::vector<Rgb> gathered = hierarchy.gather(points, goal, progress);
  progress.end();
  for (std::size_t k = 0; k < points.size(); ++k) light.H[of_point[k]] += 0.25 * gathered[k];
  for (std::size_t k = 0; k < unknowns.size(); ++k) light.B[k] = unknowns.E[k] + unknowns.rho[k] * light.H[k];
  return light;
}

}  // namespace fluxel

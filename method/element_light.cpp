#include "method/element_light.hpp"

#include <cstdint>
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
    NodeId id = tree.face(finder.find(element.patch, centroid), k < mesh.elements.size());
    constexpr double kSameArea = 1.2;  // parts of a piece are halves of halves
    while (tree[id].shape.area > kSameArea * unknowns.area[k] && !tree[id].is_leaf())
      id = tree[id].child[tree.in_first_child(id, centroid) ? 0 : 1];
    if (tree[id].shape.area <= kSameArea * unknowns.area[k]) {
      light.H[k] = H[id];
    } else {
      points.push_back({id, centroid});
      of_point.push_back(k);
    }
  }
  progress.begin("gathering for elements");
  const std::vector<Rgb> gathered = hierarchy.gather(points, goal, progress);
  progress.end();
  for (std::size_t k = 0; k < points.size(); ++k) light.H[of_point[k]] = gathered[k];
  for (std::size_t k = 0; k < unknowns.size(); ++k) light.B[k] = unknowns.E[k] + unknowns.rho[k] * light.H[k];
  return light;
}

}  // namespace fluxel

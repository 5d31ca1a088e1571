#include "method/bake_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/options.hpp"
#include "method/mesh_points.hpp"
#include "method/root_gather.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "solver/unknowns.hpp"
#include "subdivision/subdivide.hpp"

namespace fluxel {

namespace {

/// Some hundreds of megabytes on the root, of points and files.
constexpr std::size_t kMostFaces = 2'000'000;

/// Of the rays' seeds, of which probes and pictures have others.
constexpr std::uint64_t kMeshSeed = std::uint64_t{1} << 33;

bool writes_vertices(const Options& options) {
  return options.writes("glb") || options.writes("glb-quantised");
}

SplitCriterion criterion_of(const Options& options) {
  SplitCriterion criterion;
  criterion.max_edge = *options.mesh_max_edge;
  return criterion;
}

/// No face is larger than a square of the longest edge.
double least_faces(const Scene& scene, double max_edge) {
  return std::max(piece_area(scene) / (max_edge * max_edge), static_cast<double>(scene.pieces.size()));
}

[[noreturn]] void refuse_faces(const Scene& scene, double faces) {
  throw InputError(fmt::format(
      "--mesh-max-edge would make a mesh of {:.3g} faces, more than {}: ask for a larger one (they "
      "are about as many as edges of {:.2g} m would make)",
      faces, kMostFaces, 2 * std::sqrt(piece_area(scene) / static_cast<double>(kMostFaces))));
}

/// The points of the faces that have any, then of vertices; on the root.
struct RootPoints {
  std::vector<GatherPoint> points;
  std::vector<std::uint32_t> unknowns;  ///< those that the first ones are of
};

RootPoints points_of_mesh(const Options& options, const NodeTree& tree, BakedMesh& baked) {
  RootPoints found;
  const std::vector<NodeId> faces = faces_of_unknowns(tree, baked.mesh);
  if (options.writes("vtu"))
    for (std::size_t k = 0; k < faces.size(); ++k) {
      if (faces[k] == kNoNode) continue;
      found.points.push_back(
          {faces[k], glm::dvec3(baked.mesh.elements[k % baked.mesh.elements.size()].centroid)});
      found.unknowns.push_back(static_cast<std::uint32_t>(k));
    }
  if (writes_vertices(options)) {
    MeshVertices vertices = vertices_of(baked.mesh, faces);
    baked.vertices = std::move(vertices.positions);
    baked.corners = std::move(vertices.corners);
    found.points.insert(found.points.end(), vertices.points.begin(), vertices.points.end());
  }
  return found;
}

}  // namespace

bool bakes_mesh(const Options& options) {
  return options.mesh_max_edge && !options.dry_run && !options.visibility_only &&
         (options.writes("vtu") || writes_vertices(options));
}

void require_mesh_fits(const Problem& problem) {
  on_root(problem.world, [&] {
    const Scene& scene = problem.scene;
    const double least = least_faces(scene, *problem.options.mesh_max_edge);
    if (least > static_cast<double>(kMostFaces)) refuse_faces(scene, least);
    const std::size_t faces =
        subdivide_pieces(scene, 0, scene.pieces.size(), {}, criterion_of(problem.options))
            .mesh.elements.size();
    if (faces > kMostFaces) refuse_faces(scene, static_cast<double>(faces));
  });
}

void bake_mesh(const Problem& problem, IrradianceSource& source, double target, Solution& solution) {
  const NodeTree& tree = source.tree();
  BakedMesh baked;
  RootPoints root;
  on_root(problem.world, [&] {
    baked.mesh =
        subdivide_pieces(tree.scene(), 0, tree.scene().pieces.size(), {}, criterion_of(problem.options)).mesh;
    root = points_of_mesh(problem.options, tree, baked);
  });
  const RootGather light =
      gather_on_root(problem, source, root.points, allowed_noise(target), kMeshSeed, "mesh");
  if (!problem.world.is_root()) return;
  const std::vector<Rgb> H = light_of(light.halves), noise_of_H = noise_of_points(root.points, light.halves);
  if (!root.unknowns.empty()) {
    const std::size_t unknowns = make_unknowns(baked.mesh.elements, tree.scene().materials).size();
    baked.H.assign(unknowns, Rgb(0));
    baked.noise_of_H.assign(unknowns, Rgb(0));
    for (std::size_t k = 0; k < root.unknowns.size(); ++k) {
      baked.H[root.unknowns[k]] = H[k];
      baked.noise_of_H[root.unknowns[k]] = noise_of_H[k];
    }
  }
  baked.H_of_vertices.assign(H.begin() + static_cast<std::ptrdiff_t>(root.unknowns.size()), H.end());
  baked.noise = light.noise;
  solution.mesh = std::move(baked);
}

}  // namespace fluxel

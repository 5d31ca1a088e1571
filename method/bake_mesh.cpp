#include "method/bake_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/exponential.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "hierarchy/ray_gather.hpp"
#include "method/mesh_points.hpp"
#include "method/probed_rays.hpp"
#include "method/probes.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "solver/unknowns.hpp"
#include "subdivision/subdivide.hpp"

namespace fluxel {

namespace {

/// Some hundreds of megabytes on the root, of points and files.
constexpr std::size_t kMostFaces = 2'000'000;

/// Noise of the gather, root mean square over the mean: of the target error this part, and no more than the
/// other, beyond which smooth walls look blotched.
constexpr double kShareOfMesh = 0.4, kMostNoise = 0.02;

/// So many points are on all ranks at a time.
constexpr std::size_t kPointsSentAtOnce = 1 << 16;

/// Of the rays' seeds, of which probes and pictures have others.
constexpr std::uint64_t kMeshSeed = std::uint64_t{1} << 33;

/// Of a face's noise, which two halves alone hardly tell: that many before and behind it, which lie close by
/// since the mesh is in the order of bisection, are taken to have the same.
constexpr std::size_t kAlike = 8;

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

void broadcast_points(const Communicator& world, std::vector<GatherPoint>& points) {
  const auto bytes = std::as_bytes(std::span(points));
  Bytes message(bytes.begin(), bytes.end());
  world.broadcast(message);
  points.resize(message.size() / sizeof(GatherPoint));
  if (!points.empty()) std::memcpy(points.data(), message.data(), message.size());
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

/// Collective: of the root's points, on the root; two halves.
std::array<std::vector<Rgb>, 2> gather_on_root(const Problem& problem, IrradianceSource& source,
                                               std::span<const GatherPoint> points, double ray_error) {
  std::array<std::vector<Rgb>, 2> H;
  problem.progress.begin("gathering the mesh");
  SilentProgress silent;
  for (std::size_t first = 0;; first += kPointsSentAtOnce) {
    std::vector<GatherPoint> some;
    if (problem.world.is_root()) {
      const auto rest = points.subspan(std::min(first, points.size()));
      some.assign(rest.begin(),
                  rest.begin() + static_cast<std::ptrdiff_t>(std::min(kPointsSentAtOnce, rest.size())));
    }
    broadcast_points(problem.world, some);
    if (some.empty()) break;
    const auto halves = source.gather_halves(
        some, {ray_error, source.mean_radiosity(), kMeshSeed + first / kPointsSentAtOnce}, silent);
    if (!problem.world.is_root()) continue;
    for (std::size_t half = 0; half < 2; ++half)
      H[half].insert(H[half].end(), halves[half].begin(), halves[half].end());
    problem.progress.update(static_cast<double>(H[0].size()), static_cast<double>(points.size()));
  }
  problem.progress.end();
  return H;
}

/// The standard error of each unknown, by what the halves of those alike differ by.
std::vector<Rgb> noise_of_unknowns(const ElementView& mesh, std::span<const Rgb> half_difference) {
  const std::size_t count = mesh.elements.size();
  std::vector<Rgb> noise(half_difference.size(), Rgb(0));
  for (std::size_t k = 0; k < noise.size(); ++k) {
    const std::size_t side = k / count * count, at = k - side;
    const std::size_t from = side + at - std::min(at, kAlike), to = side + std::min(count, at + kAlike + 1);
    Rgb squares(0);
    double alike = 0;
    for (std::size_t other = from; other < to; ++other)
      if (mesh.elements[other - side].patch == mesh.elements[at].patch) {
        squares += half_difference[other] * half_difference[other];
        ++alike;
      }
    noise[k] = glm::sqrt(squares / alike);
  }
  return noise;
}

}  // namespace

bool bakes_mesh(const Options& options) {
  return options.mesh_max_edge && !options.dry_run && !options.visibility_only &&
         (options.writes("vtu") || writes_vertices(options));
}

void require_bakeable(const Problem& problem) {
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
  std::vector<GatherPoint> probes;
  on_root(problem.world, [&] {
    baked.mesh =
        subdivide_pieces(tree.scene(), 0, tree.scene().pieces.size(), {}, criterion_of(problem.options)).mesh;
    root = points_of_mesh(problem.options, tree, baked);
    for (const std::uint32_t number : choose_probes(tree, root.points)) probes.push_back(root.points[number]);
  });
  broadcast_points(problem.world, probes);
  const double allowed = target > 0 ? std::min(kShareOfMesh * target, kMostNoise) : kMostNoise;
  const ProbedRays rays = probe_for(source, probes, allowed);
  const auto halves = gather_on_root(problem, source, root.points, rays.ray_error);
  if (!problem.world.is_root()) return;
  const std::vector<Rgb> H = mean_of_halves(halves);
  if (!root.unknowns.empty()) {
    const std::size_t unknowns = make_unknowns(baked.mesh.elements, tree.scene().materials).size();
    baked.H.assign(unknowns, Rgb(0));
    std::vector<Rgb> half_difference(unknowns, Rgb(0));
    for (std::size_t k = 0; k < root.unknowns.size(); ++k) {
      baked.H[root.unknowns[k]] = H[k];
      half_difference[root.unknowns[k]] = 0.5 * (halves[1][k] - halves[0][k]);
    }
    baked.noise_of_H = noise_of_unknowns(baked.mesh, half_difference);
  }
  baked.H_of_vertices.assign(H.begin() + static_cast<std::ptrdiff_t>(root.unknowns.size()), H.end());
  baked.noise = rays.noise;
  solution.mesh = std::move(baked);
}

}  // namespace fluxel

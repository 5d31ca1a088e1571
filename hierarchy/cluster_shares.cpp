#include "hierarchy/cluster_shares.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"

namespace fluxel {

namespace {

/// Adds a whole number to an entry that other threads add to.
void add(std::uint64_t& sum, std::uint64_t part) {
  std::atomic_ref(sum).fetch_add(part, std::memory_order_relaxed);
}

/// A ray that leaves a face.
struct FaceRay {
  NodeId face;
  glm::dvec3 origin, direction;
};

/// Adds `part` for each cluster above the face that the ray leaves.
void add_ray(const RayScene& ray_scene, const NodeTree& tree, const FaceRay& ray, std::uint64_t part,
             std::span<std::uint64_t> sums) {
  const auto& [face, origin, direction] = ray;
  const PatchHit hit = ray_scene.first_hit(origin, direction);
  if (hit.patch == kNoPatch) return;
  const Patch& patch = tree.scene().patch(hit.patch);
  if ((patch.sides & (glm::dot(patch.normal, direction) < 0 ? kFront : kBack)) == 0) return;
  const glm::dvec3 end = origin + hit.t * direction;
  const WayParts ways = way_parts(direction);
  NodeId child = face;
  for (NodeId cluster = tree[face].parent; cluster != kNoNode;
       child = cluster, cluster = tree[cluster].parent) {
    // Clusters further up hold this one's sphere.
    if (glm::distance(end, tree[cluster].shape.centroid) <= tree[cluster].radius) return;
    for (std::size_t k = 0; k < ways.way.size(); ++k)
      add(sums[kDirections * child + ways.way[k]],
          static_cast<std::uint64_t>(static_cast<double>(part) * ways.part[k]));
  }
}

}  // namespace

std::vector<std::uint64_t> light_out(const RayScene& ray_scene, const NodeTree& tree,
                                     std::span<const NodeId> faces, int threads) {
  std::vector<std::uint64_t> sums(kDirections * tree.whole());
  const double unit = tree.size() > 0 ? std::ldexp(tree[0].shape.area, -52) : 1;  // sums stay below 2^57
  const auto epsilon = static_cast<double>(ray_scene.surface_epsilon());
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size()), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const FlatShape& shape = tree[faces[k]].shape;
        const auto part = static_cast<std::uint64_t>(shape.area / unit);
        SobolPoints places(faces[k]);
        for (int ray = 0; ray < kShareRays; ++ray) {
          const auto [u, v, s, t] = places.next();
          const glm::dvec3 origin = surface_point(tree.outline(faces[k]), s, t) + epsilon * shape.normal;
          add_ray(ray_scene, tree, {faces[k], origin, cosine_direction(u, v, shape.normal)}, part, sums);
        }
      }
    });
  });
  return sums;
}

std::vector<WayShares> cluster_shares(const NodeTree& tree, std::span<const std::uint64_t> light_out) {
  std::vector<WayShares> shares(tree.whole());
  const auto along = [&](NodeId id) { return light_out.subspan(kDirections * id, kDirections); };
  for (std::size_t id = 0; id < tree.clusters(); ++id) {
    const auto [a, b] = tree[static_cast<NodeId>(id)].child;
    const auto share = [](std::uint64_t of_a, std::uint64_t of_b, double otherwise) {
      const double sum = static_cast<double>(of_a) + static_cast<double>(of_b);
      return sum > 0 ? static_cast<double>(of_a) / sum : otherwise;
    };
    const double by_area = tree[a].shape.area / tree[static_cast<NodeId>(id)].shape.area;
    const std::uint64_t none = 0;
    const double in_all = share(std::accumulate(along(a).begin(), along(a).end(), none),
                                std::accumulate(along(b).begin(), along(b).end(), none), by_area);
    for (std::size_t way = 0; way < kDirections; ++way)
      shares[a][way] = share(along(a)[way], along(b)[way], in_all);
    shares[a][kWithin] = by_area;
    for (std::size_t way = 0; way < kWays; ++way) shares[b][way] = 1 - shares[a][way];
  }
  return shares;
}

}  // namespace fluxel

#include "hierarchy/cluster_shares.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>

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
  NodeId child = face;
  for (NodeId cluster = tree[face].parent; cluster != kNoNode;
       child = cluster, cluster = tree[cluster].parent) {
    // Clusters further up hold this one's sphere.
    if (glm::distance(end, tree[cluster].shape.centroid) <= tree[cluster].radius) return;
    add(sums[child], part);
  }
}

}  // namespace

std::vector<std::uint64_t> light_out(const RayScene& ray_scene, const NodeTree& tree,
                                     std::span<const NodeId> faces, int threads) {
  std::vector<std::uint64_t> sums(tree.whole());
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

std::vector<double> cluster_shares(const NodeTree& tree, std::span<const std::uint64_t> light_out) {
  std::vector<double> shares(tree.whole(), 1.0);
  for (std::size_t id = 0; id < tree.clusters(); ++id) {
    const auto [a, b] = tree[static_cast<NodeId>(id)].child;
    const auto of_a = static_cast<double>(light_out[a]), of_b = static_cast<double>(light_out[b]);
    shares[a] = of_a + of_b > 0 ? of_a / (of_a + of_b) : tree.share(a);
    shares[b] = 1 - shares[a];
  }
  return shares;
}

}  // namespace fluxel

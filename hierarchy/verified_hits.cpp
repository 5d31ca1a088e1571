#include "hierarchy/verified_hits.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/hash.hpp"
#include "visibility/cuda/device.hpp"

namespace fluxel {

namespace {

cuda::Double3 plain(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Evenly spread in [0, 1), by the ray alone.
double spread(const Ray& ray) {
  return 0x1p-64 * static_cast<double>(hash_bytes(std::as_bytes(std::span(&ray, 1))));
}

/// Embree compares distances in single precision: of patches at one place any may be the first.
bool is_same(const PatchHit& a, const PatchHit& b, double tie) {
  if (a.patch == b.patch) return a.t == b.t;
  return a.patch != kNoPatch && b.patch != kNoPatch && std::abs(a.t - b.t) <= tie;
}

}  // namespace

VerifiedHits::VerifiedHits(std::unique_ptr<cuda::HitFinder> finder, std::vector<PatchId> patches,
                           const RayScene& ray_scene, double verified)
    : finder_(std::move(finder)), patches_(std::move(patches)), ray_scene_(ray_scene), verified_(verified) {}

void VerifiedHits::find(std::span<const Ray> rays, std::span<PatchHit> hits) {
  if (failure_.empty()) {
    try {
      by_device(rays, hits);
      return;
    } catch (const cuda::DeviceError& error) {
      failure_ = error.what();
    }
  }
  by_processor(rays, hits);
}

void VerifiedHits::by_device(std::span<const Ray> rays, std::span<PatchHit> hits) {
  std::vector<cuda::Ray> taken;
  taken.reserve(rays.size());
  for (const Ray& ray : rays) taken.push_back({plain(ray.origin), plain(ray.direction)});
  const std::vector<cuda::NearestHit> found = finder_->find(taken);
  if (found.size() != rays.size() || std::ranges::any_of(found, [this](const cuda::NearestHit& hit) {
        return hit.patch != cuda::kNoHit && hit.patch >= patches_.size();
      }))
    throw cuda::DeviceError("it names patches that there are not");
  for (std::size_t k = 0; k < rays.size(); ++k)
    hits[k] = found[k].patch == cuda::kNoHit ? PatchHit{} : PatchHit{patches_[found[k].patch], found[k].t};
  counts_.made += rays.size();
  verify(rays, hits);
}

void VerifiedHits::by_processor(std::span<const Ray> rays, std::span<PatchHit> hits) const {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size()), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k)
      hits[k] = ray_scene_.first_hit(rays[k].origin, rays[k].direction);
  });
}

void VerifiedHits::verify(std::span<const Ray> rays, std::span<const PatchHit> hits) {
  std::vector<Ray> again;
  std::vector<PatchHit> by_device;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (!(verified_ > 0 && spread(rays[k]) <= verified_)) continue;
    again.push_back(rays[k]);
    by_device.push_back(hits[k]);
  }
  std::vector<PatchHit> expected(again.size());
  by_processor(again, expected);
  counts_.verified += again.size();
  constexpr double kTie = 1e-5;  // of the scene's extent
  for (std::size_t k = 0; k < again.size(); ++k)
    if (!is_same(by_device[k], expected[k],
                 kTie * ray_scene_.scene().extent / glm::length(again[k].direction)))
      ++counts_.differing;
}

std::vector<PatchId> patches_of(const cuda::SceneArrays& arrays) {
  std::vector<PatchId> patches;
  patches.reserve(arrays.exact.size());
  for (const cuda::ExactPatch& patch : arrays.exact) patches.push_back(PatchId{patch.number});
  return patches;
}

}  // namespace fluxel

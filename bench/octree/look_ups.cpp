#include "bench/octree/look_ups.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <nanoflann.hpp>
#include <utility>

namespace fluxel::bench {

namespace {

class OctreeLookUp final : public LookUp {
 public:
  OctreeLookUp(std::span<const Sphere> spheres, int threads) : spheres_(spheres), tree_(spheres, threads) {}
  [[nodiscard]] Held at(const glm::dvec3& point) const override {
    Held held;
    tree_.for_each_at(point, [&](std::uint32_t sphere) {
      if (holds(spheres_[sphere], point)) held.add(sphere);
    });
    return held;
  }

 private:
  std::span<const Sphere> spheres_;
  SphereOctree tree_;
};

/// The centres, as nanoflann asks for them.
struct Centres {
  std::span<const Sphere> spheres;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return spheres.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t k, std::size_t axis) const {
    return axis == 0 ? spheres[k].x : axis == 1 ? spheres[k].y : spheres[k].z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

class NanoflannLookUp final : public LookUp {
 public:
  NanoflannLookUp(std::span<const Sphere> spheres, double radius)
      : spheres_(spheres), radius_(radius), centres_{spheres}, tree_(3, centres_) {}
  [[nodiscard]] Held at(const glm::dvec3& point) const override {
    // A little more, and then what double precision says.
    const float reach = static_cast<float>(radius_ * radius_ * (1 + 1e-4));
    const float query[3] = {static_cast<float>(point.x), static_cast<float>(point.y),
                            static_cast<float>(point.z)};
    thread_local std::vector<std::pair<std::uint32_t, float>> found;
    found.clear();
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    tree_.radiusSearch(query, reach, found, unsorted);
    Held held;
    for (const auto& [sphere, distance] : found)
      if (holds(spheres_[sphere], point)) held.add(sphere);
    return held;
  }

 private:
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Centres>, Centres, 3,
                                                   std::uint32_t>;
  std::span<const Sphere> spheres_;
  double radius_;
  Centres centres_;
  Tree tree_;
};

class GridLookUp final : public LookUp {
 public:
  GridLookUp(std::span<const Sphere> spheres, double radius)
      : spheres_(spheres),
        // More than a diameter, of which single precision takes some.
        scale_(1 / (2.001 * radius)),
        mask_(std::bit_ceil(2 * spheres.size() + 1) - 1),
        first_(mask_ + 2) {
    for (const Sphere& sphere : spheres) ++first_[bucket_of(cell_of(centre(sphere))) + 1];
    for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
    std::vector<std::uint32_t> next = first_;
    numbers_.resize(spheres.size());
    for (std::uint32_t k = 0; k < spheres.size(); ++k)
      numbers_[next[bucket_of(cell_of(centre(spheres[k])))]++] = k;
  }
  /// Of the eight cubes around the corner that is nearest.
  [[nodiscard]] Held at(const glm::dvec3& point) const override {
    const glm::ivec3 from(glm::floor(point * scale_ - 0.5));
    std::array<std::size_t, 8> buckets;
    for (int k = 0; k < 8; ++k)
      buckets[static_cast<std::size_t>(k)] = bucket_of(from + glm::ivec3(k & 1, k >> 1 & 1, k >> 2));
    std::ranges::sort(buckets);
    const auto last = std::ranges::unique(buckets).begin();
    Held held;
    for (auto bucket = buckets.begin(); bucket != last; ++bucket)
      for (std::uint32_t k = first_[*bucket]; k < first_[*bucket + 1]; ++k)
        if (holds(spheres_[numbers_[k]], point)) held.add(numbers_[k]);
    return held;
  }

 private:
  [[nodiscard]] static glm::dvec3 centre(const Sphere& sphere) {
    return {static_cast<double>(sphere.x), static_cast<double>(sphere.y), static_cast<double>(sphere.z)};
  }
  [[nodiscard]] glm::ivec3 cell_of(const glm::dvec3& point) const {
    return glm::ivec3(glm::floor(point * scale_));
  }
  [[nodiscard]] std::size_t bucket_of(const glm::ivec3& cell) const {
    const auto mix = [](int value, std::uint64_t by) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value)) * by;
    };
    const std::uint64_t hash = mix(cell.x, 0x9E3779B97F4A7C15u) ^ mix(cell.y, 0xC2B2AE3D27D4EB4Fu) ^
                               mix(cell.z, 0x165667B19E3779F9u);
    return (hash >> 20) & mask_;
  }

  std::span<const Sphere> spheres_;
  double scale_;
  std::size_t mask_;
  std::vector<std::uint32_t> first_, numbers_;
};

}  // namespace

std::unique_ptr<LookUp> by_octree(std::span<const Sphere> spheres, int threads) {
  return std::make_unique<OctreeLookUp>(spheres, threads);
}
std::unique_ptr<LookUp> by_nanoflann(std::span<const Sphere> spheres, double radius) {
  return std::make_unique<NanoflannLookUp>(spheres, radius);
}
std::unique_ptr<LookUp> by_grid(std::span<const Sphere> spheres, double radius) {
  return std::make_unique<GridLookUp>(spheres, radius);
}

Held by_brute_force(std::span<const Sphere> spheres, const glm::dvec3& point) {
  Held held;
  for (std::uint32_t k = 0; k < spheres.size(); ++k)
    if (holds(spheres[k], point)) held.add(k);
  return held;
}

}  // namespace fluxel::bench

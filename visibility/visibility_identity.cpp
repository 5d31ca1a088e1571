#include "visibility/visibility_identity.hpp"

#include <string>
#include <type_traits>

#include "core/hash.hpp"
#include "visibility/instruction_set.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

namespace {

/// To be raised with every change after which the same elements may have other bits, or other tags of tiles.
constexpr std::uint64_t kTracing = 3;

/// A hash of numbers one after another, each begun with the one before it.
class Chain {
 public:
  template <class... Numbers>
  void add(const Numbers&... numbers) {
    (add_one(numbers), ...);
  }
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

 private:
  template <class Number>
  void add_one(const Number& number) {
    static_assert(std::is_trivially_copyable_v<Number>);
    hash_ = hash_bytes(std::as_bytes(std::span(&number, 1)), hash_);
  }

  std::uint64_t hash_ = 0;
};

void add(const Patch& patch, Chain& chain) {
  const std::span corners(patch.outline.corner.data(), patch.outline.corners);
  chain.add(patch.outline.corners, patch.normal);
  for (const glm::dvec3& corner : corners) chain.add(corner);
}

}  // namespace

std::uint64_t visibility_identity(const RayScene& ray_scene, std::span<const Element> elements) {
  Chain chain;
  const std::string isa = instruction_set_in_use();
  chain.add(kTracing, kTileSize, hash_bytes(std::as_bytes(std::span(isa))));
  const Scene& scene = ray_scene.scene();
  chain.add(scene.extent, ray_scene.surface_epsilon(), scene.patches.size());
  for (const Patch& patch : scene.patches) add(patch, chain);
  chain.add(elements.size());
  for (const Element& e : elements) {
    // At once: there are many.
    struct Geometry {
      glm::vec3 centroid, normal;
      float area;
      PatchId patch;
      std::uint32_t sides;
    };
    static_assert(sizeof(Geometry) == 9 * 4, "without padding");
    chain.add(Geometry{e.centroid, e.normal, e.area, e.patch, e.sides});
  }
  return chain.hash();
}

}  // namespace fluxel

#include "formfactor/visibility_probe.hpp"

#include <gtest/gtest.h>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// A floor and a ceiling 1 m apart, each 4 x 4 elements, and a plate at half height over a part of them.
struct Room {
  Scene scene = by_hand::empty_scene(Sides::one);
  ElementMesh mesh;
  std::size_t ceiling = 0, plate = 0;  // their first elements
  double end;                          // of the plate, along x

  explicit Room(double plate_end) : end(plate_end) {
    by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    by_hand::add(scene, "ceiling", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
    if (plate_end > 0)
      by_hand::add(scene, "plate", {{-1, -1, 0.5}, {plate_end, -1, 0.5}, {plate_end, 2, 0.5}, {-1, 2, 0.5}});
    scene = test_scenes::finished(std::move(scene));
    mesh = test_scenes::uniform_elements(scene, 0.25);
    while (mesh.elements[ceiling].patch == PatchId{0}) ++ceiling;
    while (plate < mesh.elements.size() && mesh.elements[plate].patch != PatchId{2}) ++plate;
  }

  [[nodiscard]] std::vector<PairBit> pairs(bool sees) const {
    std::vector<PairBit> all;
    for (std::size_t i = 0; i < ceiling; ++i)
      for (std::size_t j = ceiling; j < plate; ++j) all.push_back({i, j, sees});
    return all;
  }

  /// The hidden part of the segments between two elements, evenly spread over both: half way up their places
  /// along x are the mean of two even spreads.
  [[nodiscard]] double hidden(const PairBit& pair) const {
    const auto low = [this](std::size_t element) {
      return static_cast<double>(mesh.elements[element].centroid.x) - 0.125;
    };
    const double t = std::clamp((end - (low(pair.i) + low(pair.j)) / 2) / 0.25, 0.0, 1.0);
    return t <= 0.5 ? 2 * t * t : 1 - 2 * (1 - t) * (1 - t);
  }

  [[nodiscard]] VisibilityProbe probe(const RayScene& ray_scene, std::span<const PairBit> list) const {
    VisibilityProbe made(ray_scene, mesh);
    for (const PairBit& pair : list) made.add(pair);
    made.finish();
    return made;
  }
};

bool same(const PairBit& a, const PairBit& b) { return a.i == b.i && a.j == b.j && a.sees == b.sees; }

TEST(VisibilityProbe, ARightBitIsLeftAlone) {
  const Room free(0), blocked(2);
  const RayScene free_rays(free.scene, 1), blocked_rays(blocked.scene, 1);
  const VisibilityProbe open = free.probe(free_rays, free.pairs(true));
  EXPECT_TRUE(open.contradicted().empty());
  EXPECT_EQ(open.rays(), VisibilityProbe::kRays * 256);
  EXPECT_TRUE(blocked.probe(blocked_rays, blocked.pairs(false)).contradicted().empty());
}

TEST(VisibilityProbe, AWrongBitIsDoubted) {
  const Room free(0), blocked(2);
  const RayScene free_rays(free.scene, 1), blocked_rays(blocked.scene, 1);
  const std::vector<PairBit> all = free.pairs(false);
  const VisibilityProbe probe = free.probe(free_rays, all);
  ASSERT_EQ(probe.contradicted().size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    EXPECT_TRUE(same(probe.contradicted()[k], all[k])) << "in the order they came in";
  EXPECT_EQ(blocked.probe(blocked_rays, blocked.pairs(true)).contradicted().size(), all.size());
}

TEST(VisibilityProbe, FindsMostPairsThatAreHalfHidden) {
  const Room half(0.53);
  const RayScene ray_scene(half.scene, 1);
  int partial = 0, found = 0;
  for (const bool sees : {false, true}) {
    for (const PairBit& pair : half.pairs(sees)) {
      const double hidden = half.hidden(pair);
      const bool contradicted = !half.probe(ray_scene, std::array{pair}).contradicted().empty();
      if (hidden == 0 || hidden == 1) {
        EXPECT_EQ(contradicted, sees == (hidden == 1));
      }
      if (hidden < 0.2 || hidden > 0.8) continue;
      ++partial;
      found += contradicted ? 1 : 0;
    }
  }
  EXPECT_EQ(partial, 2 * 4 * 4 * 4) << "elements in four of the seven diagonals, four beside each other";
  EXPECT_GT(found, 0.9 * partial);
}

TEST(VisibilityProbe, APairIsJudgedByItselfAlone) {
  const Room half(0.53);
  const RayScene ray_scene(half.scene, 1);
  const std::vector<PairBit> all = half.pairs(true);
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{5}, all.size()}) {
    const auto some = std::span(all).first(count);
    const VisibilityProbe together = half.probe(ray_scene, some);
    EXPECT_EQ(together.rays(), VisibilityProbe::kRays * count);
    std::vector<PairBit> alone;
    for (const PairBit& pair : some)
      if (!half.probe(ray_scene, std::array{pair}).contradicted().empty()) alone.push_back(pair);
    EXPECT_TRUE(std::ranges::equal(together.contradicted(), alone, same)) << count;
  }
  VisibilityProbe idle(ray_scene, half.mesh);
  idle.finish();
  EXPECT_EQ(idle.rays(), 0u);
}

}  // namespace
}  // namespace fluxel

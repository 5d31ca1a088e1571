#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/unit/test_scenes.hpp"
#include "visibility/cuda/segment.hpp"
#include "visibility/segment_test.hpp"

namespace fluxel {
namespace {

using by_hand::add;
using test_scenes::uniform;

/// The surface of a solid of blocks of different sizes, some of which are there by chance, those in the
/// middle always. Each face of a block is a parallelogram, two triangles over either diagonal, or four around
/// a point that is on no lattice and off the face: no corner stands within another's edge. All other corners
/// are small whole numbers, so that products of coordinates are exact.
class SolidOfBlocks {
 public:
  explicit SolidOfBlocks(unsigned seed) : random_(seed) {
    for (auto& layer : solid_)
      for (auto& row : layer)
        for (bool& block : row) block = random_() % 2 == 0;
    for (std::size_t x : {kMiddle, kMiddle + 1})
      for (std::size_t y : {kMiddle, kMiddle + 1})
        for (std::size_t z : {kMiddle, kMiddle + 1}) solid_[x][y][z] = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t level = 0; level < kCuts.size(); ++level)
        for (std::size_t i = 0; i < kBlocks; ++i)
          for (std::size_t j = 0; j < kBlocks; ++j)
            if (is_solid(axis, level, i, j) != is_solid(axis, level + 1, i, j)) add_face(axis, level, i, j);
  }

  /// From a point of the surface on, so many times its way from a point with coordinates within kInside [m]
  /// lead out of all blocks.
  static constexpr double kInside = 0.75, kToOutside = 32;

  Scene scene = by_hand::empty_scene(Sides::one);

 private:
  static constexpr std::array kCuts{-4.0, -3.0, -1.0, 0.0, 1.0, 2.0, 4.0};
  static constexpr std::size_t kBlocks = kCuts.size() - 1, kMiddle = 2;

  /// Of the block under a level; there is nothing under the lowest and over the highest.
  [[nodiscard]] bool is_solid(std::size_t axis, std::size_t over, std::size_t i, std::size_t j) const {
    if (over == 0 || over == kCuts.size()) return false;
    std::array<std::size_t, 3> at{};
    at[axis] = over - 1, at[(axis + 1) % 3] = i, at[(axis + 2) % 3] = j;
    return solid_[at[0]][at[1]][at[2]];
  }

  void add_face(std::size_t axis, std::size_t level, std::size_t i, std::size_t j) {
    const auto at = [axis](double x, double y, double z) {
      glm::dvec3 corner;
      const auto u = static_cast<int>(axis);
      corner[u] = z, corner[(u + 1) % 3] = x, corner[(u + 2) % 3] = y;
      return corner;
    };
    const double x = kCuts[i], y = kCuts[j], z = kCuts[level], to_x = kCuts[i + 1], to_y = kCuts[j + 1];
    const std::array<glm::dvec3, 4> c{at(x, y, z), at(to_x, y, z), at(to_x, to_y, z), at(x, to_y, z)};
    const std::size_t first = random_() % 2;
    switch (random_() % 3) {
      case 0:
        add(scene, "face", {c[0], c[1], c[2], c[3]});
        break;
      case 1:
        add(scene, "face", {c[first], c[first + 1], c[first + 2]});
        add(scene, "face", {c[first + 2], c[(first + 3) % 4], c[first]});
        break;
      default:
        const glm::dvec3 middle =
            at(x + uniform(random_, 0.3, 0.7) * (to_x - x), y + uniform(random_, 0.3, 0.7) * (to_y - y),
               z + uniform(random_, -0.1, 0.1));
        for (std::size_t k = 0; k < 4; ++k) add(scene, "face", {c[k], c[(k + 1) % 4], middle});
    }
  }

  std::mt19937 random_;
  std::array<std::array<std::array<bool, kBlocks>, kBlocks>, kBlocks> solid_{};
};

/// A point of the surface: a corner, or now and then a point of an edge.
glm::dvec3 point_of_outline(const Scene& scene, std::mt19937& random) {
  const Outline<glm::dvec3>& outline = scene.patches[random() % scene.patches.size()].outline;
  const std::size_t c = random() % outline.corners;
  if (random() % 4 > 0) return outline.corner[c];
  const double s = random() % 2 == 0 ? 0.25 * static_cast<double>(1 + random() % 3) : uniform(random, 0, 1);
  return (1 - s) * outline.corner[c] + s * outline.corner[(c + 1) % outline.corners];
}

constexpr int kSolids = 20, kSegmentsOfSolid = 25000;

/// Segments through points of the outlines from the inside to the outside, or back, that meet nothing. They
/// begin at any points and at points of a lattice that is `shift` [m] off the solid's, along all axes.
int count_leaks(const Scene& scene, const glm::dquat& rotation, double shift, std::mt19937& random) {
  int count = 0;
  for (int k = 0; k < kSegmentsOfSolid; ++k) {
    glm::dvec3 inside = test_scenes::uniform_point(random, -SolidOfBlocks::kInside, SolidOfBlocks::kInside);
    if (k % 2 == 0) inside = glm::round(4.0 * inside) / 4.0 + shift;
    glm::dvec3 from = rotation * inside;
    glm::dvec3 to = from + SolidOfBlocks::kToOutside * (point_of_outline(scene, random) - from);
    if (k % 4 < 2) std::swap(from, to);
    count += std::ranges::none_of(scene.patches,
                                  [&](const Patch& patch) { return segment_meets(patch, from, to); })
                 ? 1
                 : 0;
  }
  return count;
}

// Many segments run in planes of faces, along edges and through several corners, all exactly.
TEST(Watertight, NoSegmentPassesThroughACornerOfALattice) {
  std::mt19937 random(1);
  int leaks = 0;
  for (unsigned seed = 0; seed < kSolids; ++seed)
    leaks += count_leaks(SolidOfBlocks(seed).scene, glm::dquat(1, 0, 0, 0), 0, random);
  EXPECT_EQ(leaks, 0) << "of " << kSolids * kSegmentsOfSolid;
}

// The shift keeps them out of the planes, where rounding would decide on which side an end lies.
TEST(Watertight, NoSegmentPassesThroughACornerThatIsRounded) {
  std::mt19937 random(2);
  int leaks = 0;
  for (unsigned seed = 0; seed < kSolids; ++seed) {
    Scene scene = SolidOfBlocks(seed).scene;
    const glm::dquat rotation = by_hand::random_rotation(random);
    by_hand::rotate(scene, rotation);
    leaks += count_leaks(scene, rotation, 0.125, random);
  }
  EXPECT_EQ(leaks, 0) << "of " << kSolids * kSegmentsOfSolid;
}

TEST(Watertight, ATurnIsExact) {
  constexpr double kUlp = 0x1p-52;
  // Products that differ by less than rounding can tell, about the origin and far from it.
  for (const double scale : {1.0, 0x1p-300, 0x1p300}) {
    const cuda::Place a{scale * (1 + kUlp), scale}, b{1 + 2 * kUlp, 1 + kUlp};
    ASSERT_EQ(a.u * b.v, a.v * b.u);
    EXPECT_EQ(cuda::turn(a, b), 1);
    EXPECT_EQ(cuda::turn(b, a), -1);
    EXPECT_EQ(cuda::turn(a, {-2 * a.u, -2 * a.v}), 0);
  }
}

}  // namespace
}  // namespace fluxel

#include "visibility/tile_tracer.hpp"

#include <gtest/gtest.h>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::random_plates;
using test_scenes::uniform_elements;

enum class Sight { blocked, open, too_close_to_tell };

/// Whether a segment meets a triangle or parallelogram, by its plane coordinates in double precision; too
/// close to tell where it passes the border, or ends at the plane, within a margin.
Sight past_patch(const glm::dvec3& from, const glm::dvec3& to, const Patch& patch) {
  constexpr double kMargin = 1e-4;
  const glm::dvec3 corner = patch.outline.corner[0];
  const glm::dvec3 u = patch.outline.corner[1] - corner;
  const glm::dvec3 v = patch.outline.corner[patch.outline.corners - 1] - corner;
  const glm::dvec3 n = glm::cross(u, v);
  const double along = glm::dot(n, to - from);
  const double s = glm::dot(n, corner - from) / along;
  if (!(s > -kMargin && s < 1 + kMargin)) return Sight::open;
  const glm::dvec3 x = from + s * (to - from) - corner;
  const double a = glm::dot(glm::cross(x, v), n) / glm::dot(n, n);
  const double b = glm::dot(glm::cross(u, x), n) / glm::dot(n, n);
  double inside = std::min({a, b, s, 1 - s});
  inside = std::min(inside, patch.outline.corners == 3 ? 1 - a - b : std::min(1 - a, 1 - b));
  if (inside < -kMargin) return Sight::open;
  return inside > kMargin ? Sight::blocked : Sight::too_close_to_tell;
}

Sight brute_force(const Scene& scene, const Element& i, const Element& j) {
  if (i.patch == j.patch) return Sight::blocked;
  const glm::dvec3 from(i.centroid), to(j.centroid);
  const double height_i = glm::dot(glm::dvec3(i.normal), to - from);
  const double height_j = glm::dot(glm::dvec3(j.normal), from - to);
  // At a grazing angle a ray starts and ends further from its elements: within the margin above this height.
  if (std::min(std::abs(height_i), std::abs(height_j)) < 5e-3 * scene.extent) return Sight::too_close_to_tell;
  if ((i.sides & (height_i > 0 ? kFront : kBack)) == 0) return Sight::blocked;
  if ((j.sides & (height_j > 0 ? kFront : kBack)) == 0) return Sight::blocked;
  Sight sight = Sight::open;
  for (std::size_t k = 0; k < scene.patches.size(); ++k) {
    if (PatchId{static_cast<std::uint32_t>(k)} == i.patch ||
        PatchId{static_cast<std::uint32_t>(k)} == j.patch)
      continue;
    const Sight past = past_patch(from, to, scene.patches[k]);
    if (past == Sight::blocked) return Sight::blocked;
    if (past == Sight::too_close_to_tell) sight = past;
  }
  return sight;
}

bool bit(const TracedTile& tile, std::size_t row, std::size_t column) {
  return (tile.bits[row] >> column & 1u) != 0;
}

void expect_brute_force(const Scene& scene, const std::vector<Element>& elements) {
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, elements);
  const std::size_t tiles = tile_count(elements.size());
  std::size_t open = 0, blocked = 0, unclear = 0, wrong = 0;
  for (std::size_t row = 0; row < tiles; ++row) {
    for (std::size_t column = row; column < tiles; ++column) {
      const TracedTile tile = tracer.trace(row, column);
      for (std::size_t r = 0; r < kTileSize; ++r) {
        for (std::size_t c = 0; c < kTileSize; ++c) {
          const std::size_t i = row * kTileSize + r, j = column * kTileSize + c;
          if (i >= elements.size() || j >= elements.size()) {
            EXPECT_FALSE(bit(tile, r, c)) << "a bit outside the matrix";
            continue;
          }
          const Sight sight = brute_force(scene, elements[i], elements[j]);
          if (sight == Sight::too_close_to_tell) {
            ++unclear;
            continue;
          }
          ++(sight == Sight::open ? open : blocked);
          wrong += bit(tile, r, c) != (sight == Sight::open) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(open, 1000u);
  EXPECT_GT(blocked, 1000u);
  EXPECT_LT(static_cast<double>(unclear), 0.04 * static_cast<double>(open + blocked + unclear));
}

TEST(TileTracer, AgreesWithBruteForceInTwoSidedScenes) {
  const Scene scene = random_plates(25, 0.8, Sides::two, 1);
  expect_brute_force(scene, uniform_elements(scene, 0.4).elements);
}

TEST(TileTracer, AgreesWithBruteForceInOneSidedScenes) {
  const Scene scene = random_plates(40, 0.6, Sides::one, 2);
  expect_brute_force(scene, uniform_elements(scene, 0.4).elements);
}

TEST(TileTracer, SealedSidesAreNotSeen) {
  Scene scene = random_plates(25, 0.8, Sides::two, 3);
  for (std::size_t k = 0; k < scene.patches.size(); k += 2)
    scene.patches[k].sides = k % 4 == 0 ? kFront : kBack;
  expect_brute_force(scene, uniform_elements(scene, 0.4).elements);
}

TEST(TileTracer, TheDiagonalTileIsSymmetric) {
  const Scene scene = random_plates(40, 0.6, Sides::two, 5);
  const std::vector<Element> elements = uniform_elements(scene, 0.4).elements;
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, elements);
  for (std::size_t k = 0; k < tile_count(elements.size()); ++k) {
    const TracedTile tile = tracer.trace(k, k);
    EXPECT_EQ(tile.tag, TileTag::bits);
    TileBits transposed = tile.bits;
    transpose(transposed);
    EXPECT_EQ(transposed, tile.bits);
    for (std::size_t r = 0; r < kTileSize; ++r) EXPECT_FALSE(bit(tile, r, r));
  }
}

/// Two unit squares face each other across a gap of 1, each of 64 elements: a tile each. A third plate of the
/// given width lies between them as an occluder alone; 0 for none.
struct Facing {
  Scene scene = by_hand::empty_scene(Sides::one);
  std::vector<Element> elements;

  explicit Facing(double width) {
    by_hand::add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    by_hand::add(scene, "above", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
    if (width > 0)
      by_hand::add(scene, "between",
                   {{-1, -1, 0.5}, {width - 1, -1, 0.5}, {width - 1, 2, 0.5}, {-1, 2, 0.5}});
    scene = finished(std::move(scene));
    elements = uniform_elements(scene, 0.125).elements;
    elements.resize(2 * kTileSize);
  }

  [[nodiscard]] TracedTile trace(std::size_t row, std::size_t column,
                                 Shortcuts shortcuts = Shortcuts::on) const {
    const RayScene ray_scene(scene, 1);
    return TileTracer(ray_scene, elements, shortcuts).trace(row, column);
  }
};

TEST(TileTracer, OneValueForAllPairsIsNamedWithoutRays) {
  const Facing open(0);
  const TracedTile visible = open.trace(0, 1);
  EXPECT_EQ(visible.tag, TileTag::visible);
  EXPECT_EQ(visible.rays, 0u);
  for (const std::uint64_t word : visible.bits) EXPECT_EQ(word, ~std::uint64_t{0});
  const TracedTile own_plane = open.trace(0, 0);
  EXPECT_EQ(own_plane.tag, TileTag::facing_away);
  EXPECT_EQ(own_plane.rays, 0u);

  const TracedTile blocked = Facing(3).trace(0, 1);
  EXPECT_EQ(blocked.tag, TileTag::blocked);
  EXPECT_EQ(blocked.rays, 0u);
  for (const std::uint64_t word : blocked.bits) EXPECT_EQ(word, 0u);

  const TracedTile half = Facing(1.5).trace(0, 1);
  EXPECT_EQ(half.tag, TileTag::bits);
  // The edge passes between columns of centroids: halves of 4 columns are certain.
  EXPECT_LT(half.rays, kTileSize * kTileSize / 2);

  Facing turned(0);
  for (Element& element : turned.elements) element.normal = -element.normal;
  EXPECT_EQ(turned.trace(0, 1).tag, TileTag::facing_away);
  EXPECT_EQ(turned.trace(0, 1).rays, 0u);
}

TEST(TileTracer, WithoutShortcutsEveryFacingPairIsARay) {
  for (const double width : {0.0, 1.5, 3.0}) {
    const TracedTile tile = Facing(width).trace(0, 1, Shortcuts::off);
    EXPECT_EQ(tile.rays, kTileSize * kTileSize);
    EXPECT_EQ(tile.bits, Facing(width).trace(0, 1).bits);
  }
  EXPECT_EQ(Facing(0).trace(0, 0, Shortcuts::off).rays, 0u);
}

TEST(TileTracer, APartlyFilledTileCanBeVisible) {
  Facing open(0);
  open.elements.resize(kTileSize + 5);
  const TracedTile tile = open.trace(0, 1);
  EXPECT_EQ(tile.tag, TileTag::visible);
  for (const std::uint64_t word : tile.bits) EXPECT_EQ(word, low_bits(5));
}

TEST(TileTracer, PatchesOfOnePlaneNeverSeeEachOther) {
  std::mt19937 random(6);
  for (int repeat = 0; repeat < 50; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::two);
    by_hand::add(scene, "left", {{-1, -1, 0.3}, {0, -1, 0.3}, {0, 1, 0.3}, {-1, 1, 0.3}});
    by_hand::add(scene, "right", {{0, -1, 0.3}, {1, -1, 0.3}, {1, 1, 0.3}, {0, 1, 0.3}});
    by_hand::add(scene, "turned", {{1, -1, 0.3}, {1, 1, 0.3}, {2, 1, 0.3}, {2, -1, 0.3}});
    by_hand::rotate(scene, by_hand::random_rotation(random));
    scene = finished(std::move(scene));
    const RayScene ray_scene(scene, 1);
    const TracedTile tile = TileTracer(ray_scene, uniform_elements(scene, 0.5).elements).trace(0, 0);
    EXPECT_EQ(tile.rays, 0u);
    EXPECT_EQ(tile.tag, TileTag::facing_away);
  }
}

// A ray that started where it has left the floor's plane would begin behind the wall.
TEST(TileTracer, AWallBesideAnElementIsNotJumpedAtAGrazingAngle) {
  constexpr double kSmall = 1e-4;
  for (const bool with_wall : {true, false}) {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add(scene, "floor",
                 {{-2 * kSmall, -kSmall, 0}, {0, -kSmall, 0}, {0, kSmall, 0}, {-2 * kSmall, kSmall, 0}});
    by_hand::add(scene, "target",
                 {{4, -kSmall, 0}, {4, -kSmall, 2 * kSmall}, {4, kSmall, 2 * kSmall}, {4, kSmall, 0}});
    if (with_wall) by_hand::add(scene, "wall", {{0, -2, -1}, {0, 2, -1}, {0, 2, 2}, {0, -2, 2}});
    scene = finished(std::move(scene));
    std::vector<Element> elements = uniform_elements(scene, 1).elements;
    elements.resize(2);
    const RayScene ray_scene(scene, 1);
    EXPECT_EQ(bit(TileTracer(ray_scene, elements).trace(0, 0), 0, 1), !with_wall);
  }
}

/// Plates with corners on a grid of 2^-16, so that a scale by a power of two and a shift round nothing.
SceneInput gridded_plates(double scale, const glm::dvec3& shift) {
  SceneInput input;
  input.materials = {{"white", Rgb{0.5}, Rgb{1.0}, {}, {}}};
  input.groups = {"plates"};
  for (const Patch& patch : random_plates(25, 0.8, Sides::two, 8).patches) {
    InputPolygon polygon;
    for (std::size_t c = 0; c < 3; ++c)  // triangles: they stay flat on the grid
      polygon.corners.push_back(scale * (glm::round(patch.outline.corner[c] * 0x1p16) * 0x1p-16) + shift);
    input.polygons.push_back(polygon);
  }
  return input;
}

std::vector<TileBits> all_bits(const SceneInput& input, double max_edge) {
  SceneSettings settings;
  settings.cut = false;  // cutting works with tolerances, which are not the subject here
  const Scene scene = build_scene(input, settings);
  const std::vector<Element> elements = uniform_elements(scene, max_edge).elements;
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, elements);
  std::vector<TileBits> bits;
  for (std::size_t row = 0; row < tile_count(elements.size()); ++row)
    for (std::size_t column = row; column < tile_count(elements.size()); ++column)
      bits.push_back(tracer.trace(row, column).bits);
  return bits;
}

TEST(TileTracer, MovingTheSceneFarAwayChangesNothing) {
  const std::vector<TileBits> here = all_bits(gridded_plates(1, glm::dvec3(0)), 0.3);
  EXPECT_GT(here.size(), 5u);
  EXPECT_EQ(all_bits(gridded_plates(1, {16384, -65536, 1048576}), 0.3), here);
}

TEST(TileTracer, ScalingTheSceneByPowersOfTwoChangesNothing) {
  const std::vector<TileBits> unscaled = all_bits(gridded_plates(1, glm::dvec3(0)), 0.3);
  for (const double scale : {0x1p-10, 0x1p-3, 0x1p10})
    EXPECT_EQ(all_bits(gridded_plates(scale, glm::dvec3(0)), 0.3 * scale), unscaled) << scale;
}

TEST(TileTracer, AgreesWithBruteForceAtEveryScale) {
  for (const double scale : {1e-3, 0.37, 1e3}) {
    const Scene scene = build_scene(gridded_plates(scale, scale * glm::dvec3(1e3, 2e3, 3e3)), {});
    expect_brute_force(scene, uniform_elements(scene, 0.3 * scale).elements);
  }
}

}  // namespace
}  // namespace fluxel

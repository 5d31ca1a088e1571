#include "subdivision/subdivide.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "subdivision/bisection.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::look;

Outline3 in_double(const Outline<glm::vec3>& single) {
  Outline3 outline;
  outline.corners = single.corners;
  for (std::size_t c = 0; c < single.corners; ++c) outline.corner[c] = glm::dvec3(single.corner[c]);
  return outline;
}

/// A scene of the project, seen and subdivided as a run does by default.
class SubdividedScenes : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    test_scenes::SceneOfFile loaded = test_scenes::load(GetParam(), 64, 48);
    scene = std::move(loaded.scene);
    camera = loaded.camera;
    raster = look(RayScene(scene, 1), scene, camera);
    seen = seen_points(scene, camera, 1, raster);
    criterion.max_pixels = 1;
    criterion.max_edge = loaded.max_edge.value_or(default_max_edge(scene, seen.size()));
    whole = subdivide_pieces(scene, 0, scene.pieces.size(), seen, criterion);
  }

  Scene scene;
  Camera camera;
  Raster raster;
  std::vector<SeenPoint> seen;
  SplitCriterion criterion;
  SubdividedPieces whole;
};

TEST_P(SubdividedScenes, EveryPixelHasOneElementAndNoElementTwoPixels) {
  std::vector<int> elements_of(raster.pixels(), 0);
  std::vector<int> pixels_of(whole.mesh.elements.size(), 0);
  ASSERT_EQ(whole.pixels.size(), whole.pixel_element.size());
  for (std::size_t k = 0; k < whole.pixels.size(); ++k) {
    const std::size_t pixel = whole.pixels[k];
    const Element& element = whole.mesh.elements.at(whole.pixel_element[k]);
    ++elements_of[pixel];
    ++pixels_of[whole.pixel_element[k]];
    EXPECT_EQ(element.patch, raster.patch[pixel]);
  }
  std::size_t seeing = 0;
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel) {
    const bool sees = raster.patch[pixel] != kNoPatch;
    seeing += sees ? 1 : 0;
    EXPECT_EQ(elements_of[pixel], sees ? 1 : 0);
  }
  EXPECT_GT(seeing, raster.pixels() / 10);
  EXPECT_EQ(std::ranges::max(pixels_of), 1);
}

TEST_P(SubdividedScenes, AnElementHoldsThePointThatItsPixelSees) {
  const PixelRays rays(camera);
  for (std::size_t k = 0; k < whole.pixels.size(); ++k) {
    const Outline3 outline = in_double(whole.mesh.outlines[whole.pixel_element[k]]);
    const glm::dvec3 normal(whole.mesh.elements[whole.pixel_element[k]].normal);
    const glm::dvec3 point = pixel_point(scene, camera, rays, raster, whole.pixels[k]);
    for (std::uint32_t c = 0; c < outline.corners; ++c) {
      const glm::dvec3 along = glm::normalize(outline.corner[(c + 1) % outline.corners] - outline.corner[c]);
      EXPECT_GT(glm::dot(glm::cross(normal, along), point - outline.corner[c]), -1e-5 * scene.extent);
    }
  }
}

TEST_P(SubdividedScenes, StepsStayBelowTheBound) {
  for (std::size_t first = 0; first < scene.pieces.size();) {
    const PatchId patch = scene.pieces[first].patch;
    std::size_t last = first;
    while (last < scene.pieces.size() && scene.pieces[last].patch == patch) ++last;
    double nearest = test_scenes::kUnbounded;
    for (const SeenPoint& point : seen)
      if (point.patch == patch) nearest = std::min(nearest, raster.depth[point.pixel]);
    int bound = 0;
    for (std::size_t piece = first; piece < last; ++piece) {
      const Outline3& root = scene.pieces[piece].outline;
      bound = std::max(bound, step_bound(root, criterion.max_edge));
      if (std::isfinite(nearest))
        bound = std::max(bound, step_bound(root, least_pixel_spacing(camera, 1, nearest)));
    }
    EXPECT_LE(subdivide_pieces(scene, first, last, seen, criterion).max_depth, bound);
    first = last;
  }
  EXPECT_GT(whole.max_depth, 3);
}

TEST_P(SubdividedScenes, AreasOfElementsAddUpToThePatchs) {
  std::vector<double> of_elements(scene.patches.size(), 0), of_pieces(scene.patches.size(), 0);
  for (const Piece& piece : scene.pieces) of_pieces[index(piece.patch)] += area(piece.outline);
  for (std::size_t i = 0; i < whole.mesh.elements.size(); ++i) {
    const Element& element = whole.mesh.elements[i];
    of_elements[index(element.patch)] += static_cast<double>(element.area);
    // Corners are rounded by up to half a unit in the last place of the extent, in three coordinates.
    const Outline3 outline = in_double(whole.mesh.outlines[i]);
    const double rounding = scene.extent * 0x1p-24 * std::sqrt(3.0);
    EXPECT_NEAR(area(outline), static_cast<double>(element.area),
                4 * diameter(outline) * rounding + 1e-7 * area(outline));
    EXPECT_LE(longest_edge(outline), criterion.max_edge + 2 * rounding);
    EXPECT_LT(glm::distance(glm::dvec3(element.centroid), centroid(outline)), 3 * rounding);
  }
  // Each area is rounded once to single precision.
  for (std::size_t patch = 0; patch < scene.patches.size(); ++patch)
    EXPECT_NEAR(of_elements[patch], of_pieces[patch], 0x1p-24 * of_pieces[patch] * 1.001);
}

TEST_P(SubdividedScenes, ElementsRenderedShowTheSamePatches) {
  Scene rendered = by_hand::empty_scene(Sides::one);
  for (std::size_t i = 0; i < whole.mesh.elements.size(); ++i) {
    Patch patch = scene.patch(whole.mesh.elements[i].patch);
    patch.outline = in_double(whole.mesh.outlines[i]);
    rendered.patches.push_back(patch);
  }
  rendered = finished(std::move(rendered));
  const RayScene ray_scene(rendered, 1);
  const PixelRays rays(camera);
  std::size_t other_patch = 0, other_element = 0;
  for (std::size_t k = 0; k < whole.pixels.size(); ++k) {
    const std::size_t pixel = whole.pixels[k];
    const auto column = static_cast<int>(pixel % static_cast<std::size_t>(camera.width));
    const auto row = static_cast<int>(pixel / static_cast<std::size_t>(camera.width));
    const PatchHit hit = ray_scene.first_hit(camera.eye - scene.origin, rays.direction(column, row));
    ASSERT_NE(hit.patch, kNoPatch) << "a hole between the elements";
    other_patch += whole.mesh.elements[index(hit.patch)].patch != raster.patch[pixel] ? 1 : 0;
    other_element += index(hit.patch) != whole.pixel_element[k] ? 1 : 0;
  }
  EXPECT_EQ(other_patch, 0u);
  // A point on the line between two elements may round to either of them.
  EXPECT_LE(static_cast<double>(other_element), 0.02 * static_cast<double>(whole.pixels.size()));
}

TEST_P(SubdividedScenes, AnyPartsGiveTheElementsOfTheWhole) {
  for (const std::size_t parts : {std::size_t{1}, std::size_t{2}, std::size_t{7}, scene.pieces.size() + 3}) {
    const std::vector<std::size_t> first = split_pieces(scene, parts);
    ASSERT_EQ(first.size(), parts + 1);
    EXPECT_EQ(first.front(), 0u);
    EXPECT_EQ(first.back(), scene.pieces.size());
    std::vector<Element> elements;
    int max_depth = 0;
    std::size_t pixels = 0;
    for (std::size_t part = 0; part < parts; ++part) {
      ASSERT_LE(first[part], first[part + 1]);
      if (first[part] > 0 && first[part] < scene.pieces.size()) {
        EXPECT_NE(scene.pieces[first[part]].patch, scene.pieces[first[part] - 1].patch)
            << "a patch was split";
      }
      const SubdividedPieces own = subdivide_pieces(scene, first[part], first[part + 1], seen, criterion);
      elements.insert(elements.end(), own.mesh.elements.begin(), own.mesh.elements.end());
      max_depth = std::max(max_depth, own.max_depth);
      pixels += own.pixels.size();
    }
    ASSERT_EQ(elements.size(), whole.mesh.elements.size());
    EXPECT_EQ(std::memcmp(elements.data(), whole.mesh.elements.data(), elements.size() * sizeof(Element)), 0);
    EXPECT_EQ(max_depth, whole.max_depth);
    EXPECT_EQ(pixels, seen.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Files, SubdividedScenes,
                         testing::Values("cornell-box", "emitting-wall", "three-rectangles",
                                         "construction-in-wood", "office-2391", "courtyard"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Subdivide, ElementsCarryWhatTheirPatchSays) {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "plate", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, by_hand::kLight);
  scene.patches[0].sides = kBack;
  scene = finished(std::move(scene));
  const ElementMesh mesh = test_scenes::uniform_elements(scene, 1);
  ASSERT_EQ(mesh.elements.size(), 2u);
  EXPECT_EQ(mesh.elements[0].centroid, glm::vec3(0.5f, 0.5f, 0));
  EXPECT_EQ(mesh.elements[1].centroid, glm::vec3(1.5f, 0.5f, 0)) << "depth first";
  for (const Element& element : mesh.elements) {
    EXPECT_EQ(element.area, 1.0f);
    EXPECT_EQ(element.normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(element.patch, PatchId{0});
    EXPECT_EQ(element.material, by_hand::kLight);
    EXPECT_EQ(element.sides, kBack);
  }
}

// Squares are split to edges between half of the longest allowed and itself: between P / 16 and P / 4
// elements.
TEST(Subdivide, TheDefaultOfTheLongestEdgeGivesTheUnseenAModestShare) {
  const Scene scene = test_scenes::unit_cube();
  EXPECT_DOUBLE_EQ(default_max_edge(scene, 4800), std::sqrt(16 * 6.0 / 4800));
  for (std::size_t pixels = 1000; pixels < 20'000; pixels += 700) {
    const double max_edge = default_max_edge(scene, pixels);
    const std::size_t elements = test_scenes::uniform_elements(scene, max_edge).elements.size();
    EXPECT_GE(elements, pixels / 16);
    EXPECT_LE(elements, pixels / 4 + 1);
  }
  EXPECT_TRUE(std::isfinite(default_max_edge(scene, 0)));
}

TEST(Subdivide, PixelsOfACutPatchGoToThePieceThatHoldsThem) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "plate", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  scene.pieces = {{{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 4}, PatchId{0}},
                  {{{{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}}, 4}, PatchId{0}}};
  scene.extent = 2;
  SplitCriterion criterion;
  criterion.max_pixels = 1;
  const std::vector<SeenPoint> seen{{0, PatchId{0}, {1.9, 0.5, 0}}, {1, PatchId{0}, {0.2, 0.5, 0}}};
  const SubdividedPieces both = subdivide_pieces(scene, 0, 2, seen, criterion);
  EXPECT_EQ(both.mesh.elements.size(), 2u) << "a pixel each: nothing to split";
  ASSERT_EQ(both.pixels.size(), 2u);
  EXPECT_EQ(both.pixels[0], 1u);
  EXPECT_EQ(both.pixel_element[0], 0u);
  EXPECT_EQ(both.pixels[1], 0u);
  EXPECT_EQ(both.pixel_element[1], 1u);
}

// Debelov & Sattarov's eq. (7) bounds the steps by log(q / R_max) / log(s), with q the size of a pixel on the
// raster [-1, 1]^2, R_max the largest circumscribed radius and s = sqrt(5/8) for rectangles. It knows nothing
// of the distance: a square seen from very near needs more.
TEST(Subdivide, TheSourcesBoundFailsOnASquareSeenFromVeryNear) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "square", {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}});
  scene = finished(std::move(scene));
  Camera camera;
  camera.eye = {0.123, 0.071, 0.01};
  camera.look_at = {0.123, 0.071, 0};
  camera.width = camera.height = 64;
  const Raster raster = look(RayScene(scene, 1), scene, camera);
  SplitCriterion criterion;
  criterion.max_pixels = 1;
  const std::vector<SeenPoint> seen = seen_points(scene, camera, 1, raster);
  ASSERT_EQ(seen.size(), 64u * 64u);
  const SubdividedPieces result = subdivide_pieces(scene, 0, 1, seen, criterion);

  const double steps_of_eq_7 = std::log((2.0 / 64) / std::sqrt(0.5)) / std::log(std::sqrt(5.0 / 8.0));
  EXPECT_GT(result.max_depth, std::ceil(steps_of_eq_7));
  EXPECT_LE(result.max_depth,
            step_bound(scene.pieces[0].outline, least_pixel_spacing(camera, 1, 0.01 - 1e-12)));
}

}  // namespace
}  // namespace fluxel

#include "subdivision/coarsen.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::look;

void expect_same_bytes(const ElementMesh& mesh, const ElementMesh& expected) {
  ASSERT_EQ(mesh.elements.size(), expected.elements.size());
  EXPECT_EQ(
      std::memcmp(mesh.elements.data(), expected.elements.data(), expected.elements.size() * sizeof(Element)),
      0);
  ASSERT_EQ(mesh.outlines.size(), expected.outlines.size());
  EXPECT_EQ(std::memcmp(mesh.outlines.data(), expected.outlines.data(),
                        expected.outlines.size() * sizeof(Outline<glm::vec3>)),
            0);
}

/// Each coarse element is as large as the consecutive fine ones that it is said to be made of, and lies in
/// their patch.
void expect_unions(const CoarseMesh& coarse, std::span<const Element> fine) {
  ASSERT_EQ(coarse.first.size(), coarse.size() + 1);
  EXPECT_EQ(coarse.first.front(), 0u);
  EXPECT_EQ(coarse.first.back(), fine.size());
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    const Element& element = coarse.mesh.elements[i];
    ASSERT_LT(coarse.first[i], coarse.first[i + 1]);
    double area = 0;
    glm::dvec3 moment(0);
    for (std::size_t k = coarse.first[i]; k < coarse.first[i + 1]; ++k) {
      EXPECT_EQ(fine[k].patch, element.patch);
      EXPECT_EQ(fine[k].sides, element.sides);
      area += static_cast<double>(fine[k].area);
      moment += static_cast<double>(fine[k].area) * glm::dvec3(fine[k].centroid);
    }
    const auto whole = static_cast<double>(element.area);
    EXPECT_NEAR(area, whole, 2e-7 * whole);
    EXPECT_LT(glm::distance(moment / area, glm::dvec3(element.centroid)),
              1e-6 * (1 + glm::length(glm::dvec3(element.centroid))));
  }
}

/// Scenes with triangles and parallelograms, of one piece a patch and of several.
class CoarsenedScenes : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    test_scenes::SceneOfFile loaded = test_scenes::load(GetParam(), 33, 24);
    scene = std::move(loaded.scene);
    camera = loaded.camera;
  }

  Scene scene;
  Camera camera;
};

// Subdivision of a part of the pixels is done anew, from the points themselves.
TEST_P(CoarsenedScenes, AreTheMeshesOfFewerPixelsAndLongerEdges) {
  Raster raster = look(RayScene(scene, 1), scene, camera);
  const std::vector<SeenPoint> seen = seen_points(scene, camera, 1, raster);
  SplitCriterion criterion{1, default_max_edge(scene, seen.size())};
  const SubdividedPieces whole = subdivide_pieces(scene, 0, scene.pieces.size(), seen, criterion);
  for (std::size_t k = 0; k < whole.pixels.size(); ++k)
    raster.element[whole.pixels[k]] = ElementId{whole.pixel_element[k]};

  ElementMesh fine = whole.mesh;
  std::vector<std::byte> levels = pixel_levels(raster, fine.elements.size());
  for (const int k : {1, 2}) {
    SCOPED_TRACE(k);
    const std::size_t step = std::size_t{1} << k;
    std::vector<SeenPoint> part;
    for (const SeenPoint& point : seen)
      if (point.pixel % 33 % step == 0 && point.pixel / 33 % step == 0) part.push_back(point);
    criterion.max_edge *= 2;
    const CoarseMesh coarse = coarsen(scene, fine.elements, levels, k, criterion.max_edge);
    expect_same_bytes(coarse.mesh, subdivide_pieces(scene, 0, scene.pieces.size(), part, criterion).mesh);
    expect_unions(coarse, fine.elements);
    EXPECT_LT(coarse.size(), fine.elements.size());
    fine = coarse.mesh;
    levels = coarse.pixel_levels;
  }
}

TEST_P(CoarsenedScenes, WithoutACameraAreTheMeshesOfLongerEdges) {
  const double max_edge = scene.extent / 12;
  const ElementMesh fine = test_scenes::uniform_elements(scene, max_edge);
  const std::vector<std::byte> levels(fine.elements.size());
  const CoarseMesh coarse = coarsen(scene, fine.elements, levels, 1, 2 * max_edge);
  expect_same_bytes(coarse.mesh, test_scenes::uniform_elements(scene, 2 * max_edge));
  expect_unions(coarse, fine.elements);
  expect_same_bytes(coarsen(scene, fine.elements, levels, 1, max_edge).mesh, fine);
}

INSTANTIATE_TEST_SUITE_P(Files, CoarsenedScenes,
                         testing::Values("cornell-box", "emitting-wall", "three-rectangles",
                                         "construction-in-wood", "office-2391", "courtyard"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Coarsen, SidesAreThoseOfThePatch) {
  const Scene scene = test_scenes::random_plates(9, 0.7, Sides::two, 3);
  const ElementMesh fine = test_scenes::uniform_elements(scene, 0.1);
  const CoarseMesh coarse =
      coarsen(scene, fine.elements, std::vector<std::byte>(fine.elements.size()), 1, 0.2);
  expect_unions(coarse, fine.elements);
  for (const Element& element : coarse.mesh.elements) EXPECT_EQ(element.sides, kFront | kBack);
}

TEST(Coarsen, WholePatchesStay) {
  const Scene scene = test_scenes::unit_cube();
  const ElementMesh fine = test_scenes::uniform_elements(scene, test_scenes::kUnbounded);
  const CoarseMesh coarse =
      coarsen(scene, fine.elements, std::vector<std::byte>(6), 1, test_scenes::kUnbounded);
  expect_same_bytes(coarse.mesh, fine);
  EXPECT_EQ(coarse.first, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(Coarsen, PixelLevelsOfMergedElementsAreTheHighest) {
  const Scene scene = test_scenes::unit_square(Sides::one);
  const ElementMesh fine = test_scenes::uniform_elements(scene, 0.5);
  ASSERT_EQ(fine.elements.size(), 4u);
  const auto levels = [](int a, int b, int c, int d) {
    return std::vector{std::byte(a), std::byte(b), std::byte(c), std::byte(d)};
  };
  const CoarseMesh one = coarsen(scene, fine.elements, levels(1, 2, 0, 1), 1, 2);
  EXPECT_EQ(one.pixel_levels, std::vector{std::byte{2}}) << "one pixel counts";
  const CoarseMesh halves = coarsen(scene, fine.elements, levels(1, 2, 0, 3), 1, 2);
  EXPECT_EQ(halves.pixel_levels, (std::vector{std::byte{2}, std::byte{3}})) << "two pixels count";
  EXPECT_EQ(halves.first, (std::vector<std::uint32_t>{0, 2, 4}));
}

TEST(Coarsen, PixelLevelsCountThePowersOfTwo) {
  Raster raster;
  raster.width = 5;
  raster.height = 3;
  raster.depth.resize(15);
  raster.element.assign(15, kNoElement);
  raster.element[6] = ElementId{0};   // column 1, row 1
  raster.element[7] = ElementId{1};   // 2, 1
  raster.element[12] = ElementId{2};  // 2, 2
  raster.element[14] = ElementId{3};  // 4, 2
  raster.element[4] = ElementId{4};   // 4, 0
  const std::vector<std::byte> expected{std::byte{1}, std::byte{1}, std::byte{2},
                                        std::byte{2}, std::byte{3}, std::byte{0}};
  EXPECT_EQ(pixel_levels(raster, 6), expected);
}

TEST(Coarsen, ElementsOfAnotherSceneAreRefused) {
  const Scene scene = test_scenes::unit_cube();
  const ElementMesh fine = test_scenes::uniform_elements(scene, 0.5);
  const std::vector<std::byte> levels(fine.elements.size());
  const auto merge = [&](std::span<const Element> elements) {
    return coarsen(scene, elements, levels, 1, 1).size();
  };
  EXPECT_EQ(merge(fine.elements), 6u);
  EXPECT_THROW(merge(std::span(fine.elements).first(23)), std::logic_error);
  EXPECT_THROW(merge(std::span(fine.elements).last(23)), std::logic_error);
  std::vector<Element> more = fine.elements;
  more.push_back(more.back());
  EXPECT_THROW((void)coarsen(scene, more, std::vector<std::byte>(25), 1, 1), std::logic_error);
}

}  // namespace
}  // namespace fluxel

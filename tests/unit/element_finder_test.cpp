#include "subdivision/element_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/sampling.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform;

std::size_t most_of_a_patch(const ElementMesh& mesh, std::size_t patches) {
  std::vector<std::size_t> of_patch(patches);
  for (const Element& element : mesh.elements) ++of_patch[index(element.patch)];
  return *std::ranges::max_element(of_patch);
}

/// Edges of 2: one element or two a patch, looked at one by one; 0.05: hundreds, found by their boxes.
class ElementFinders : public testing::TestWithParam<double> {};

TEST_P(ElementFinders, FindTheElementThatAPointWasDrawnFrom) {
  const Scene scene = test_scenes::random_plates(12, 1, Sides::two, 3);
  const ElementMesh mesh = test_scenes::uniform_elements(scene, GetParam());
  EXPECT_EQ(most_of_a_patch(mesh, scene.patches.size()) > 8, GetParam() < 1);
  const ElementFinder finder(mesh);
  std::mt19937 random(4);
  for (int k = 0; k < 2000; ++k) {
    const std::size_t element = random() % mesh.elements.size();
    // Away from the edges, which two have.
    const double u = uniform(random, 0.1, 0.9);
    const glm::dvec3 point = surface_point(mesh.outlines[element], u, uniform(random, 0.1, 0.9));
    const PatchId patch = mesh.elements[element].patch;
    EXPECT_EQ(finder.find(patch, point), element);
    const PatchId other{static_cast<std::uint32_t>((index(patch) + 1) % scene.patches.size())};
    const std::size_t of_other = finder.find(other, point);
    EXPECT_TRUE(of_other == ElementFinder::kNone || mesh.elements[of_other].patch == other);
  }
}

TEST_P(ElementFinders, OnACornerTheLowestElementIsTaken) {
  const Scene scene = test_scenes::unit_square(Sides::one);
  const ElementMesh mesh = test_scenes::uniform_elements(scene, GetParam());
  const ElementFinder finder(mesh);
  for (std::size_t element = 0; element < mesh.elements.size(); ++element)
    for (std::size_t k = 0; k < mesh.outlines[element].corners; ++k)
      EXPECT_LE(finder.find(mesh.elements[element].patch, glm::dvec3(mesh.outlines[element].corner[k])),
                element);
}

TEST_P(ElementFinders, PointsBesideAPatchHaveNone) {
  const Scene scene = test_scenes::unit_square(Sides::one);
  const ElementMesh mesh = test_scenes::uniform_elements(scene, GetParam());
  const ElementFinder finder(mesh);
  const glm::dvec3 middle(mesh.elements[0].centroid);
  EXPECT_EQ(finder.find(mesh.elements[0].patch, middle + glm::dvec3(3, 3, 0)), ElementFinder::kNone);
  EXPECT_EQ(finder.find(PatchId{7}, middle), ElementFinder::kNone);
}

INSTANTIATE_TEST_SUITE_P(Edges, ElementFinders, testing::Values(2.0, 0.05));

}  // namespace
}  // namespace fluxel

#include "visibility/narrow_gaps.hpp"

#include <gtest/gtest.h>

#include "tests/unit/refined_tree.hpp"

namespace fluxel {
namespace {

using test_scenes::TreeOfScene;

/// Shelves of 1 m x 1 m, 0.1 m apart, that face each other, and a floor that faces neither.
TreeOfScene shelves() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "lower", {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  by_hand::add(scene, "upper", {{0, 0, 1.1}, {0, 1, 1.1}, {1, 1, 1.1}, {1, 0, 1.1}});
  by_hand::add(scene, "floor", {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}});
  return TreeOfScene(test_scenes::finished(std::move(scene)));
}

TEST(NarrowGaps, AreNamedWithTheLightInThem) {
  const TreeOfScene made = shelves();
  const RayScene ray_scene(made.tree.scene(), 1);
  const ElementMesh mesh = made.tree.elements();
  ASSERT_EQ(mesh.elements.size(), 3U);
  const NarrowGaps gaps = find_narrow_gaps(ray_scene, mesh, std::vector<Rgb>{Rgb(1), Rgb(2), Rgb(3)});
  EXPECT_NEAR(gaps.share, 0.5, 1e-6);
  EXPECT_EQ(gaps.group, "upper");
  EXPECT_EQ(gaps.other, "lower");
  EXPECT_NEAR(gaps.width, 0.1, 1e-6);
  EXPECT_NEAR(gaps.length, 1, 1e-6);
}

TEST(NarrowGaps, AreNoneWhereElementsAreSmallOrNoLightArrives) {
  TreeOfScene made = shelves();
  const RayScene ray_scene(made.tree.scene(), 1);
  EXPECT_EQ(find_narrow_gaps(ray_scene, made.tree.elements(), std::vector<Rgb>(3, Rgb(0))).share, 0);
  EXPECT_EQ(find_narrow_gaps(ray_scene, made.tree.elements(), std::vector<Rgb>{Rgb(0), Rgb(0), Rgb(3)}).share,
            0);
  made.halve_all(4);
  ASSERT_EQ(made.tree.elements().elements.size(), 48U);
  const ElementMesh quarters = made.tree.elements();
  EXPECT_EQ(find_narrow_gaps(ray_scene, quarters, std::vector<Rgb>(quarters.elements.size(), Rgb(1))).share,
            0);
}

TEST(NarrowGaps, AreNotUnderARoofNorBehindWhatSendsNothing) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "loft", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "roof", {{0, 0, 0}, {0, 1, 0}, {1, 1, 0.5}, {1, 0, 0.5}});
  by_hand::add(scene, "wall", {{5, 0, 0}, {5, 1, 0}, {5, 1, 1}, {5, 0, 1}});
  by_hand::add(scene, "poster", {{5.1, 0, 0}, {5.1, 1, 0}, {5.1, 1, 1}, {5.1, 0, 1}});
  const TreeOfScene made(test_scenes::finished(std::move(scene)));
  const RayScene ray_scene(made.tree.scene(), 1);
  const ElementMesh mesh = made.tree.elements();
  EXPECT_EQ(find_narrow_gaps(ray_scene, mesh, std::vector<Rgb>(mesh.elements.size(), Rgb(1))).share, 0);
}

}  // namespace
}  // namespace fluxel

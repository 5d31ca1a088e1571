#include "formfactor/escape_fraction.hpp"

#include <gtest/gtest.h>

#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::finished;
using test_scenes::uniform_elements;

constexpr SideView kUntouched{-1, -1};

struct Views {
  std::vector<SideView> front, back;
};

Views views_of(const Scene& scene, const ElementMesh& mesh) {
  const std::size_t n = mesh.elements.size();
  Views views{std::vector<SideView>(n, kUntouched), std::vector<SideView>(n, kUntouched)};
  side_views(RayScene(scene, 1), scene, mesh, 0, n, {views.front, views.back});
  return views;
}

TEST(EscapeFraction, NothingLeavesAClosedBox) {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 5; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add_box(scene, "box", {-1, -0.6, -0.3}, {1, 0.6, 0.3}, false);
    by_hand::rotate(scene, by_hand::random_rotation(random));
    scene = finished(std::move(scene));
    for (const SideView& view : views_of(scene, uniform_elements(scene, 0.1)).front) {
      EXPECT_EQ(view.escape, 0.0f);
      EXPECT_EQ(view.dark, 0.0f);
    }
  }
}

TEST(EscapeFraction, AllLeavesASinglePlate) {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "plate", {{0, 0, 1}, {1, 0, 1}, {1, 1, 2}, {0, 1, 2}});
  by_hand::add(scene, "triangle", {{1, 0, 1}, {2, 0, 1}, {1, 1, 2}});
  scene = finished(std::move(scene));
  const Views views = views_of(scene, uniform_elements(scene, 0.3));
  for (const std::vector<SideView>& side : {views.front, views.back}) {
    for (const SideView& view : side) {
      EXPECT_EQ(view.escape, 1.0f);
      EXPECT_EQ(view.dark, 0.0f);
    }
  }
}

// A unit cube without its lid: what leaves from the floor is the form factor to the lid, C-11 for a gap of 1.
TEST(EscapeFraction, AFloorSeesTheMissingLid) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "cube", glm::dvec3(-0.5), glm::dvec3(0.5), false);
  scene.patches.erase(scene.patches.begin() + 1);
  scene = finished(std::move(scene));
  const ElementMesh mesh = uniform_elements(scene, 0.0625);
  const Views views = views_of(scene, mesh);
  const std::size_t floor = 256;
  double sum = 0;
  for (std::size_t i = 0; i < floor; ++i) {
    ASSERT_EQ(mesh.elements[i].patch, PatchId{0});
    sum += static_cast<double>(views.front[i].escape);
  }
  // Strata can only make the standard error smaller than that of independent rays.
  constexpr double kExact = 0.199824895698387;
  const double standard_error = std::sqrt(kExact * (1 - kExact) / static_cast<double>(floor * kEscapeRays));
  EXPECT_NEAR(sum / static_cast<double>(floor), kExact, 4 * standard_error);
  // By reciprocity and symmetry a side wall loses the factor between adjacent faces, C-14.
  constexpr double kAdjacent = 0.200043776075403;
  sum = 0;
  for (std::size_t i = floor; i < 5 * floor; ++i) sum += static_cast<double>(views.front[i].escape);
  EXPECT_NEAR(sum / static_cast<double>(4 * floor), kAdjacent,
              4 * std::sqrt(kAdjacent * (1 - kAdjacent) / static_cast<double>(4 * floor * kEscapeRays)));
}

TEST(EscapeFraction, BacksOfOneSidedPatchesAreDark) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "inside", {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}});
  by_hand::add_box(scene, "box", glm::dvec3(-1), glm::dvec3(1), true);
  scene = finished(std::move(scene));
  const ElementMesh mesh = uniform_elements(scene, 0.5);
  const Views views = views_of(scene, mesh);
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const bool inside = mesh.elements[i].patch == PatchId{0};
    EXPECT_EQ(views.front[i].dark, inside ? 1.0f : 0.0f);
    EXPECT_EQ(views.front[i].escape, inside ? 0.0f : 1.0f);
    EXPECT_EQ(views.back[i].escape, kUntouched.escape) << "a side that is no unknown is left alone";
    EXPECT_EQ(views.back[i].dark, kUntouched.dark);
  }
}

// A plate below the middle of a wide roof, one-sided and facing up like it: all but what slips out sideways
// ends on the roof's back. The point in the middle sees a disc of radius R at height h as R^2 / (R^2 + h^2).
TEST(EscapeFraction, EscapeAndDarkAddUpWhereNothingElseIs) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "plate", {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}});
  by_hand::add(scene, "roof", {{-2, -2, 1}, {2, -2, 1}, {2, 2, 1}, {-2, 2, 1}});
  scene = finished(std::move(scene));
  const Views views = views_of(scene, uniform_elements(scene, 0.05));
  double dark = 0;
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(views.front[i].escape + views.front[i].dark, 1.0f);
    dark += static_cast<double>(views.front[i].dark) / 16;
  }
  EXPECT_GT(dark, 4.0 / 5);  // the disc inside the roof
  EXPECT_LT(dark, 8.0 / 9);  // the disc around it
}

/// What the plate below two wide sheets sees of them; both are given facing up and may be turned.
SideView view_past_sheets(double first_height, bool first_up, double second_height, bool second_up) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "plate", {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}});
  const auto add_sheet = [&](double height, bool up) {
    const Polygon sheet = closed_forms::horizontal({-9, 9, -9, 9}, height);
    by_hand::add(scene, "sheet", up ? sheet : closed_forms::reversed(sheet));
  };
  add_sheet(first_height, first_up);
  add_sheet(second_height, second_up);
  scene = finished(std::move(scene));
  return views_of(scene, uniform_elements(scene, 1)).front[0];
}

// Which of two coincident sheets a ray meets first depends on their order: what ends there ends on the side
// that is an unknown.
TEST(EscapeFraction, SheetsBackToBackAreNotDark) {
  for (const double gap : {0.0, 1e-7, -1e-7}) {
    EXPECT_EQ(view_past_sheets(1, true, 1 + gap, false).dark, 0.0f) << gap;
    EXPECT_EQ(view_past_sheets(1, false, 1 + gap, true).dark, 0.0f) << gap;
  }
}

TEST(EscapeFraction, ADarkSideStaysDarkBeforeWhateverElse) {
  EXPECT_GT(view_past_sheets(1, true, 1, true).dark, 0.9f) << "another dark side";
  EXPECT_GT(view_past_sheets(1, true, 1.001, false).dark, 0.9f) << "an unknown side further away";
  EXPECT_EQ(view_past_sheets(1, true, 0.999, false).dark, 0.0f) << "an unknown side before it";
}

TEST(EscapeFraction, AnySplitOfTheRangeGivesTheSameViews) {
  const Scene scene = test_scenes::random_plates(20, 0.8, Sides::two, 4);
  const ElementMesh mesh = uniform_elements(scene, 0.5);
  const Views whole = views_of(scene, mesh);
  const RayScene ray_scene(scene, 1);
  const std::size_t n = mesh.elements.size();
  for (const std::size_t step : {std::size_t{1}, std::size_t{7}, n / 2}) {
    for (std::size_t first = 0; first < n; first += step) {
      const std::size_t last = std::min(n, first + step);
      std::vector<SideView> front(last - first, kUntouched), back(last - first, kUntouched);
      side_views(ray_scene, scene, mesh, first, last, {front, back});
      for (std::size_t i = first; i < last; ++i) {
        EXPECT_EQ(front[i - first].escape, whole.front[i].escape);
        EXPECT_EQ(back[i - first].escape, whole.back[i].escape);
      }
    }
  }
}

}  // namespace
}  // namespace fluxel

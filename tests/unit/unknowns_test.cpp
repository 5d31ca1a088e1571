#include "solver/unknowns.hpp"

#include <gtest/gtest.h>

namespace fluxel {
namespace {

const std::vector<Material> kMaterials{{"white", Rgb{0.5, 0.6, 0.7}, Rgb{0.0}, Sides::one},
                                       {"light", Rgb{0.1}, Rgb{1.0, 2.0, 3.0}, Sides::two}};

Element element(std::uint32_t material, std::uint32_t sides, float area) {
  Element made;
  made.material = MaterialId{material};
  made.sides = sides;
  made.area = area;
  return made;
}

TEST(Unknowns, OneSidedElementsHaveOneEach) {
  const std::vector<Element> elements{element(0, kFront, 2), element(1, kFront, 3)};
  const Unknowns unknowns = make_unknowns(elements, kMaterials);
  EXPECT_EQ(unknowns.elements, 2u);
  EXPECT_FALSE(unknowns.two_sided);
  EXPECT_EQ(unknowns.active, 2u);
  EXPECT_EQ(unknowns.E, (std::vector<Rgb>{Rgb(0), Rgb(1, 2, 3)}));
  EXPECT_EQ(unknowns.rho, (std::vector<Rgb>{Rgb(0.5, 0.6, 0.7), Rgb(0.1)}));
  EXPECT_EQ(unknowns.area, (std::vector<double>{2, 3}));
}

TEST(Unknowns, BacksFollowAllFrontsAndDoNotEmit) {
  const std::vector<Element> elements{element(0, kFront, 2), element(1, kFront | kBack, 3),
                                      element(1, kBack, 4)};
  const Unknowns unknowns = make_unknowns(elements, kMaterials);
  EXPECT_EQ(unknowns.elements, 3u);
  EXPECT_TRUE(unknowns.two_sided);
  EXPECT_EQ(unknowns.active, 4u);
  ASSERT_EQ(unknowns.size(), 6u);
  EXPECT_EQ(unknowns.E, (std::vector<Rgb>{Rgb(0), Rgb(1, 2, 3), Rgb(0), Rgb(0), Rgb(0), Rgb(0)}));
  EXPECT_EQ(unknowns.rho,
            (std::vector<Rgb>{Rgb(0.5, 0.6, 0.7), Rgb(0.1), Rgb(0), Rgb(0), Rgb(0.1), Rgb(0.1)}));
  EXPECT_EQ(unknowns.area, (std::vector<double>{2, 3, 0, 0, 3, 4}));
}

TEST(Unknowns, AreCountedWithoutTheirValues) {
  const std::vector<Element> one{element(0, kFront, 2), element(1, kFront, 3), element(1, 0, 3)};
  EXPECT_FALSE(count_unknowns(one).two_sided);
  EXPECT_EQ(count_unknowns(one).active, 2u);
  const std::vector<Element> two{element(1, kFront | kBack, 3), element(0, kFront, 2), element(0, kBack, 2)};
  EXPECT_TRUE(count_unknowns(two).two_sided);
  EXPECT_EQ(count_unknowns(two).active, 4u);
}

TEST(Unknowns, HeatIsEmittedByBothSides) {
  const std::vector<Material> warm{{"warm", Rgb{0.25}, Rgb{7.0}, Sides::two, ThermalSurface{0.75, 300.0, 0}}};
  const std::vector<Element> elements{element(0, kFront | kBack, 3), element(0, kBack, 4)};
  const Unknowns unknowns = make_unknowns(elements, warm);
  EXPECT_EQ(unknowns.E, (std::vector<Rgb>{Rgb(7), Rgb(0), Rgb(7), Rgb(7)}));
  EXPECT_EQ(unknowns.rho, (std::vector<Rgb>{Rgb(0.25), Rgb(0), Rgb(0.25), Rgb(0.25)}));
}

TEST(Unknowns, TheMeanIsWeightedByArea) {
  const std::vector<Element> elements{element(0, kFront, 1), element(0, kFront | kBack, 3)};
  const Unknowns unknowns = make_unknowns(elements, kMaterials);
  const std::vector<Rgb> x{Rgb(1, 0, 7), Rgb(2, 0, 7), Rgb(1000), Rgb(4, 7, 7)};
  const Rgb mean = area_mean(unknowns, x);
  EXPECT_DOUBLE_EQ(mean.r, (1 + 6 + 12) / 7.0) << "the third entry is no unknown";
  EXPECT_DOUBLE_EQ(mean.g, 3);
  EXPECT_DOUBLE_EQ(mean.b, 7);
  EXPECT_EQ(area_mean(make_unknowns({}, kMaterials), {}), Rgb(0));
}

}  // namespace
}  // namespace fluxel

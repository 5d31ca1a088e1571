#include "optics/scattering.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace fluxel {
namespace {

const glm::dvec3 kUpwards{0, 0, 1};

SideLight side_with(const Rgb& rho, const SurfaceOptics& optics, bool active = true) {
  return {active, rho, Rgb(0), optics};
}

/// A unit direction that comes down at an angle to the vertical.
glm::dvec3 coming_down(double angle, double turn = 0.3) {
  return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), -std::cos(angle)};
}

std::vector<std::pair<Way, Rgb>> listed_ways(const Ways& ways) {
  std::vector<std::pair<Way, Rgb>> list;
  for (const WayShare& one : ways.list()) list.emplace_back(one.way, one.share);
  return list;
}

double sum_of(const Rgb& colour) { return colour.r + colour.g + colour.b; }

TEST(Ways, AreTheSharesOfASide) {
  const SideLight side = side_with(Rgb(0.1, 0.2, 0.3), {Rgb(0.2), Rgb(0, 0, 0.1), Rgb(0.3), 0});
  const std::vector<std::pair<Way, Rgb>> all = {{Way::diffuse, Rgb(0.1, 0.2, 0.3)},
                                                {Way::mirror, Rgb(0.2)},
                                                {Way::through, Rgb(0, 0, 0.1)},
                                                {Way::diffuse_through, Rgb(0.3)}};
  for (const bool front : {true, false}) {
    EXPECT_EQ(listed_ways(Ways(side, front, front ? coming_down(0.4) : -coming_down(0.4), kUpwards)), all);
    EXPECT_EQ(listed_ways(Ways(side_with(Rgb(0.5), {}), front, coming_down(0.4), kUpwards)),
              (std::vector<std::pair<Way, Rgb>>{{Way::diffuse, Rgb(0.5)}}));
    EXPECT_TRUE(listed_ways(Ways(side_with(Rgb(0), {}), front, coming_down(0.4), kUpwards)).empty())
        << "black";
  }
}

TEST(Ways, OfASideThatDoesNotReceiveThereAreNone) {
  EXPECT_TRUE(listed_ways(Ways(side_with(Rgb(0.5), {Rgb(0.25), Rgb(0.25), Rgb(0), 0}, false), true,
                               coming_down(0.4), kUpwards))
                  .empty());
  EXPECT_TRUE(listed_ways(Ways(side_with(Rgb(0), {Rgb(0), Rgb(0), Rgb(0), 1.5}, false), true,
                               coming_down(0.4), kUpwards))
                  .empty());
}

TEST(Ways, OfAClearBodyAreFresnels) {
  const SideLight glass = side_with(Rgb(0), {Rgb(0), Rgb(0), Rgb(0), 1.5});
  for (const bool front : {true, false}) {
    const Ways ways(glass, front, front ? coming_down(0.5) : -coming_down(0.5), kUpwards);
    const double R = fresnel_reflectance(std::cos(0.5), front ? 1 / 1.5 : 1.5);
    ASSERT_EQ(ways.list().size(), 2u);
    EXPECT_EQ(ways.list()[0].way, Way::mirror);
    EXPECT_NEAR(ways.list()[0].share.g, R, 1e-14);
    EXPECT_EQ(ways.list()[1].way, Way::refracted);
    EXPECT_NEAR(ways.list()[1].share.g, 1 - R, 1e-14);
  }
  const Ways total(glass, false, -coming_down(1.0), kUpwards);  // sin(1) * 1.5 > 1
  EXPECT_EQ(listed_ways(total), (std::vector<std::pair<Way, Rgb>>{{Way::mirror, Rgb(1)}}));
}

TEST(Fresnel, NormalIncidence) {
  for (const double index : {1.0, 1.33, 1.5, 2.4}) {
    const double expected = std::pow((index - 1) / (index + 1), 2);
    EXPECT_NEAR(fresnel_reflectance(1, index), expected, 1e-15);
    EXPECT_NEAR(fresnel_reflectance(1, 1 / index), expected, 1e-15);
  }
}

/// Born & Wolf, Principles of Optics, 1.5.2: by sines and tangents of both angles.
TEST(Fresnel, ObliqueIncidence) {
  for (const double index : {1.33, 1.5, 1 / 1.5})
    for (const double angle : {0.1, 0.4, 0.7}) {
      const double behind = std::asin(std::sin(angle) / index);
      const double across = std::sin(angle - behind) / std::sin(angle + behind);
      const double along = std::tan(angle - behind) / std::tan(angle + behind);
      EXPECT_NEAR(fresnel_reflectance(std::cos(angle), 1 / index), 0.5 * (across * across + along * along),
                  1e-14);
    }
  // At Brewster's angle, tan = index, nothing of the one polarisation is reflected, and the rays are at right
  // angles.
  const double brewster = std::atan(1.5), across = std::sin(2 * brewster - 0.5 * std::acos(-1.0));
  EXPECT_NEAR(fresnel_reflectance(std::cos(brewster), 1 / 1.5), 0.5 * across * across, 1e-15);
}

TEST(Fresnel, IsTheSameInBothDirections) {
  for (const double index : {1.33, 1.5})
    for (const double angle : {0.0, 0.3, 0.9, 1.5}) {
      const double behind = std::asin(std::sin(angle) / index);
      EXPECT_NEAR(fresnel_reflectance(std::cos(angle), 1 / index),
                  fresnel_reflectance(std::cos(behind), index), 1e-13);
    }
}

TEST(Fresnel, TotalReflection) {
  const double critical = std::asin(1 / 1.5);
  EXPECT_EQ(fresnel_reflectance(std::cos(critical + 1e-6), 1.5), 1);
  EXPECT_LT(fresnel_reflectance(std::cos(critical - 1e-3), 1.5), 0.9);
  EXPECT_EQ(fresnel_reflectance(0.1, 1.5), 1);
  EXPECT_NEAR(fresnel_reflectance(1e-9, 1 / 1.5), 1, 1e-7) << "grazing";
}

TEST(Directions, Mirrored) {
  const glm::dvec3 direction = coming_down(0.6);
  for (const glm::dvec3& normal : {kUpwards, -kUpwards})
    EXPECT_LT(glm::distance(mirrored(direction, normal), glm::dvec3(direction.x, direction.y, -direction.z)),
              1e-15);
}

TEST(Directions, RefractedObeysSnell) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, -2, 3));
  std::mt19937 random(4);
  std::normal_distribution<double> gauss;
  for (const double ratio : {1 / 1.5, 1.0, 1.5})
    for (int k = 0; k < 100; ++k) {
      glm::dvec3 direction = glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
      if (glm::dot(direction, normal) > 0) direction = -direction;
      const double sine = glm::length(glm::cross(direction, normal));
      if (ratio * sine > 0.999) continue;
      const glm::dvec3 behind = refracted(direction, normal, ratio);
      EXPECT_NEAR(glm::length(behind), 1, 1e-15);
      EXPECT_LT(glm::dot(behind, normal), 0) << "it goes on to the other side";
      // n sin of both angles, on the same side of the normal and in the same plane.
      EXPECT_LT(glm::distance(glm::cross(behind, normal), ratio * glm::cross(direction, normal)), 1e-14);
    }
}

TEST(Directions, StraightDepartures) {
  const SurfaceOptics glass{Rgb(0), Rgb(0), Rgb(0), 1.5};
  const glm::dvec3 in = coming_down(0.6);
  const Departure mirror = straight_departure(Way::mirror, {}, true, in, kUpwards);
  EXPECT_EQ(mirror.direction, mirrored(in, kUpwards));
  EXPECT_TRUE(mirror.same_side);
  const Departure through = straight_departure(Way::through, {}, true, in, kUpwards);
  EXPECT_EQ(through.direction, in);
  EXPECT_FALSE(through.same_side);
  const Departure into = straight_departure(Way::refracted, glass, true, in, kUpwards);
  EXPECT_FALSE(into.same_side);
  EXPECT_NEAR(std::hypot(into.direction.x, into.direction.y), std::sin(0.6) / 1.5, 1e-15);
  // Out of the other side, which is parallel: as it has come.
  const Departure out = straight_departure(Way::refracted, glass, false, into.direction, -kUpwards);
  EXPECT_FALSE(out.same_side);
  EXPECT_LT(glm::distance(out.direction, in), 1e-15);
}

/// Numbers of a list, which counts how many were asked for.
struct ListedNumbers {
  double operator()() { return numbers.at(asked++); }
  std::vector<double> numbers;
  std::size_t asked = 0;
};

TEST(ChooseWay, WhatIsCertainAsksForNoNumber) {
  ListedNumbers none;
  const ChosenWay mirror = choose_way(
      Ways(side_with(Rgb(0), {.mirror = Rgb(1)}), true, coming_down(0.4), kUpwards), Rgb(1, 2, 0), none);
  EXPECT_TRUE(mirror.goes_on);
  EXPECT_EQ(mirror.way, Way::mirror);
  EXPECT_EQ(mirror.colour, Rgb(1, 2, 0));
  EXPECT_FALSE(mirror.drew);
  const ChosenWay black =
      choose_way(Ways(side_with(Rgb(0), {}), true, coming_down(0.4), kUpwards), Rgb(1), none);
  EXPECT_FALSE(black.goes_on);
  EXPECT_FALSE(black.drew);
  const SideLight red = side_with(Rgb(1, 0, 0), {});
  EXPECT_EQ(choose_way(Ways(red, true, coming_down(0.4), kUpwards), Rgb(2, 0, 0), none).way, Way::diffuse)
      << "certain for light of that colour";
  EXPECT_EQ(none.asked, 0u);
}

/// By a fine even grid of numbers: each way as often as its part of the light, and what is left of the
/// numbers even again, so that their means over n equal parts of [0, 1) hold an n-th each.
TEST(ChooseWay, EachAsOftenAsItsLightAndTheRestIsEven) {
  constexpr int kNumbers = 1 << 16, kParts = 4;
  const SideLight side =
      side_with(Rgb(0.25, 0, 0.125), {Rgb(0.125), Rgb(0, 0.25, 0.25), Rgb(0.125, 0.5, 0), 0});
  const Rgb colour(1, 2, 4);
  const Ways ways(side, true, coming_down(0.4), kUpwards);
  std::map<Way, int> counts;
  std::map<Way, std::array<int, kParts>> rests;
  Rgb on(0);
  int absorbed = 0;
  for (int k = 0; k < kNumbers; ++k) {
    ListedNumbers one{{(k + 0.5) / kNumbers}};
    const ChosenWay chosen = choose_way(ways, colour, one);
    EXPECT_EQ(one.asked, 1u);
    if (!chosen.goes_on) {
      ++absorbed;
      continue;
    }
    EXPECT_TRUE(chosen.drew);
    EXPECT_NEAR(sum_of(chosen.colour), sum_of(colour), 1e-12) << "a photon keeps its power";
    ASSERT_GE(chosen.rest, 0);
    ASSERT_LT(chosen.rest, 1);
    ++counts[chosen.way];
    ++rests[chosen.way][static_cast<std::size_t>(chosen.rest * kParts)];
    on += chosen.colour / static_cast<double>(kNumbers);
  }
  // Of colour (1, 2, 4), 7 in all: rho 0.25 + 0.5, mirror 0.875, through 0.5 + 1, diffusely 0.125 + 1.
  const std::map<Way, double> expected = {{Way::diffuse, 0.75 / 7},
                                          {Way::mirror, 0.875 / 7},
                                          {Way::through, 1.5 / 7},
                                          {Way::diffuse_through, 1.125 / 7}};
  for (const auto& [way, share] : expected) {
    EXPECT_NEAR(counts[way], share * kNumbers, 2);
    for (const int part : rests[way]) EXPECT_NEAR(part, counts[way] / double{kParts}, 2);
  }
  EXPECT_NEAR(absorbed, (7 - 4.25) / 7 * kNumbers, 2);
  // In the mean each colour gets on what the shares say of it: 0.5, 0.875 and 0.5 of it.
  EXPECT_NEAR(on.r, 0.5, 1e-3);
  EXPECT_NEAR(on.g, 2 * 0.875, 1e-3);
  EXPECT_NEAR(on.b, 4 * 0.5, 1e-3);
}

TEST(ChooseWay, TheRestIsBelowOne) {
  const Ways ways(side_with(Rgb(0.3), {.mirror = Rgb(0.1)}), true, coming_down(0.4), kUpwards);
  for (const double number : {0.3, 0.4}) {
    ListedNumbers before{{std::nextafter(number, 0)}};
    EXPECT_LT(choose_way(ways, Rgb(1), before).rest, 1);
  }
}

}  // namespace
}  // namespace fluxel

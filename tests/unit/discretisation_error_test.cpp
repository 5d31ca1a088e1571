#include "solver/discretisation_error.hpp"

#include <gtest/gtest.h>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// The elements of a square of side 1 and their B = f(centroid).
struct Plate {
  std::vector<Element> elements;
  Unknowns unknowns;

  explicit Plate(double max_edge, Sides sides = Sides::one) {
    const Scene scene = test_scenes::unit_square(sides);
    elements = test_scenes::uniform_elements(scene, max_edge).elements;
    unknowns = make_unknowns(elements, scene.materials);
  }

  template <class Function>
  [[nodiscard]] std::vector<double> values(const Function& f) const {
    std::vector<double> B(unknowns.size());
    for (std::size_t i = 0; i < B.size(); ++i) B[i] = f(glm::dvec3(elements[i % elements.size()].centroid));
    return B;
  }

  template <class Function>
  [[nodiscard]] double estimate(const Function& f) const {
    return DiscretisationError(elements, unknowns).estimate<double>(values(f));
  }
};

// A linear B varies over an element of side h by |grad B| h / sqrt(12).
TEST(DiscretisationError, OfALinearRadiosity) {
  for (const double h : {1.0 / 8, 1.0 / 32}) {
    const Plate plate(h);
    for (const glm::dvec3 gradient : {glm::dvec3(1, 0, 0), glm::dvec3(0, 3, 0), glm::dvec3(2, -1, 0)}) {
      const double exact = glm::length(gradient) * h / std::sqrt(12.0);
      const double estimate = plate.estimate([&](const glm::dvec3& x) { return glm::dot(gradient, x); });
      EXPECT_GT(estimate, exact / 1.5);
      EXPECT_LT(estimate, 1.5 * exact);
    }
  }
}

// exp(-4 (x^2 + y^2)) around the square's middle, against the integral over each element.
TEST(DiscretisationError, OfASpotOfLight) {
  const auto spot = [](const glm::dvec3& x) { return std::exp(-4 * glm::dot(x, x)); };
  for (const int n : {8, 32}) {
    const double h = 1.0 / n;
    double square = 0;
    constexpr int kSamples = 8;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int s = 0; s < kSamples * kSamples; ++s) {
          const auto at = [&](double u, double v) { return spot({(i + u) * h - 0.5, (j + v) * h - 0.5, 0}); };
          const double u = (s % kSamples + 0.5) / kSamples,
                       v = (static_cast<int>(s / kSamples) + 0.5) / kSamples;
          square += std::pow(at(u, v) - at(0.5, 0.5), 2) * h * h / (kSamples * kSamples);
        }
    const double estimate = Plate(h).estimate(spot);
    EXPECT_GT(estimate, std::sqrt(square) / 1.5);
    EXPECT_LT(estimate, 1.5 * std::sqrt(square));
  }
}

TEST(DiscretisationError, OfAnEvenRadiosityIsNone) {
  EXPECT_EQ(Plate(0.1).estimate([](const glm::dvec3&) { return 3.0; }), 0);
}

TEST(DiscretisationError, BothSidesCount) {
  const Plate plate(0.1, Sides::two);
  const std::size_t n = plate.elements.size();
  ASSERT_EQ(plate.unknowns.size(), 2 * n);
  const DiscretisationError error(plate.elements, plate.unknowns);
  std::vector<double> front = plate.values([](const glm::dvec3&x) { return x.x; }), both = front;
  std::fill(front.begin() + static_cast<std::ptrdiff_t>(n), front.end(), 5.0);
  // Half of the area varies: a mean square half as large.
  EXPECT_NEAR(error.estimate<double>(front), error.estimate<double>(both) / std::sqrt(2.0), 1e-12);
  std::vector<Rgb> colours(2 * n);
  for (std::size_t i = 0; i < 2 * n; ++i) colours[i] = {front[i], both[i], 0};
  const Rgb of_colours = error.estimate<Rgb>(colours);
  EXPECT_EQ(of_colours, Rgb(error.estimate<double>(front), error.estimate<double>(both), 0));
}

TEST(DiscretisationError, IsUnknownWhereNoPatchIsSplit) {
  const Scene cube = test_scenes::unit_cube();
  const auto elements = test_scenes::uniform_elements(cube, test_scenes::kUnbounded).elements;
  EXPECT_FALSE(DiscretisationError(elements, make_unknowns(elements, cube.materials)).known());
  EXPECT_TRUE(Plate(0.5).elements.size() > 1);
}

}  // namespace
}  // namespace fluxel

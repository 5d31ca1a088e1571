#include "scene/readers/gltf_lights.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/unit/gltf_files.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::gltf_lights_test {
namespace {

using gltf_files::error_of;
using gltf_files::json;
using gltf_files::Triangle;
using test_messages::expect_words;

constexpr double kPi = std::numbers::pi;

/// A triangle, and a node for each light, moved by (1, 2, 3) and scaled by 4.
Triangle with_lights(const char* lights) {
  Triangle triangle;
  triangle["/extensionsRequired"] = {"KHR_lights_punctual"};
  triangle["/extensions/KHR_lights_punctual/lights"] = json::parse(lights);
  for (std::size_t k = 0; k < triangle["/extensions/KHR_lights_punctual/lights"].size(); ++k) {
    triangle["/nodes"].push_back({{"translation", {1, 2, 3}},
                                  {"scale", {4, 4, 4}},
                                  {"extensions", {{"KHR_lights_punctual", {{"light", k}}}}}});
  }
  return triangle;
}

/// The table at an angle, linear between its angles; nothing beyond them.
double at(const IntensityTable& table, double gamma) {
  for (std::size_t k = 1; k < table.gamma.size(); ++k) {
    if (gamma > table.gamma[k]) continue;
    const double t = (gamma - table.gamma[k - 1]) / (table.gamma[k] - table.gamma[k - 1]);
    return (1 - t) * table.intensity[k - 1] + t * table.intensity[k];
  }
  return 0;
}

/// By the midpoint rule with so many steps that its error is below 1e-7 of the result.
double flux_of(const IntensityTable& table) {
  constexpr int kSteps = 100'000;
  const double step = table.gamma.back() / kSteps;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) sum += at(table, (k + 0.5) * step) * std::sin((k + 0.5) * step);
  return 2 * kPi * sum * step;
}

TEST(GltfLights, PointsShineTheSameAllAround) {
  const SceneInput scene = gltf_files::read(
      with_lights(
          R"([{"name": "bulb", "type": "point", "color": [1, 0.5, 0.25], "intensity": 80, "range": 3}])")
          .text());
  EXPECT_EQ(scene.units, Units::photometric);
  ASSERT_EQ(scene.luminaires.size(), 1u);
  const Luminaire& bulb = scene.luminaires[0];
  EXPECT_EQ(bulb.name, "bulb");
  EXPECT_EQ(bulb.position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(bulb.size, glm::dvec2(0));
  EXPECT_EQ(bulb.scale, Rgb(80, 40, 20));  // whatever the node's scale
  ASSERT_EQ(scene.intensities.size(), 1u);
  EXPECT_NEAR(flux_of(scene.intensities[bulb.intensity]), 4 * kPi, 1e-6);
  EXPECT_EQ(scene.intensities[0].C, std::vector<double>{0});
  ASSERT_EQ(scene.notes.size(), 2u);  // and the triangle without a material
  expect_words(scene.notes[0], {"lights have a range, which is ignored: light has none (1)"});
}

TEST(GltfLights, NodesOfOneLightShareItsTable) {
  Triangle triangle = with_lights(R"([{"type": "point"}])");
  triangle["/nodes"].push_back(triangle["/nodes/1"]);
  triangle["/nodes/2/name"] = "desk";
  const SceneInput scene = gltf_files::read(triangle.text());
  ASSERT_EQ(scene.luminaires.size(), 2u);
  EXPECT_EQ(scene.luminaires[0].name, "light 0");
  EXPECT_EQ(scene.luminaires[1].name, "desk");
  EXPECT_EQ(scene.luminaires[1].scale, Rgb(1));
  EXPECT_EQ(scene.intensities.size(), 1u);
}

TEST(GltfLights, SpotsAimAlongTheirNode) {
  Triangle triangle =
      with_lights(R"([{"type": "spot", "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5}}])");
  const double half = std::sqrt(0.5);
  triangle["/nodes/1/rotation"] = {-half, 0, 0, half};  // -90 degrees about x: -z becomes -y
  const Luminaire spot = gltf_files::read(triangle.text()).luminaires[0];
  EXPECT_NEAR(glm::length(spot.aim - glm::dvec3(0, -1, 0)), 0, 1e-15);
  EXPECT_NEAR(glm::length(spot.ahead - glm::dvec3(1, 0, 0)), 0, 1e-15);
}

TEST(GltfLights, SpotsFallOffAsTheExtensionSays) {
  const IntensityTable table = spot_intensity(0.2, 0.5);
  EXPECT_EQ(at(table, 0), 1);
  EXPECT_EQ(at(table, 0.2), 1);
  EXPECT_EQ(at(table, 0.5), 0);
  EXPECT_EQ(at(table, 0.51), 0);
  for (const double gamma : {0.21, 0.3, 0.4123, 0.49}) {
    // The extension's code: saturate(cos(gamma) * scale + offset) squared.
    const double scale = 1 / (std::cos(0.2) - std::cos(0.5)), offset = -std::cos(0.5) * scale;
    const double linear = std::cos(gamma) * scale + offset;
    EXPECT_NEAR(at(table, gamma), linear * linear, 2e-4) << gamma;
  }
}

TEST(GltfLights, TablesOfSpotsHaveTheFluxOfTheirFormula) {
  for (const auto& [inner, outer] :
       {std::pair{0.0, 0.7853981634}, {0.2, 0.5}, {0.0, kPi / 2}, {1.5, 1.55}, {0.0, 0.01}}) {
    // The integral over 2 pi d(cos gamma): 1 within the inner cone, t^2 with t from 0 to 1 between.
    const double exact = 2 * kPi * (1 - std::cos(inner) + (std::cos(inner) - std::cos(outer)) / 3);
    EXPECT_NEAR(flux_of(spot_intensity(inner, outer)) / exact, 1, 2e-4) << inner << ' ' << outer;
  }
}

TEST(GltfLights, ConesOfOneAngleHaveASharpEdge) {
  const IntensityTable table = spot_intensity(0.5, 0.5);
  EXPECT_EQ(table.gamma, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(table.intensity, (std::vector<double>{1, 1}));
}

TEST(GltfLights, RefusesWhatItCannotModel) {
  const auto error = [](const char* light) { return error_of(with_lights(light).text()); };
  expect_words(error(R"([{"type": "directional"}])"),
               {"dir/a.gltf: ", "lights[0]", "directional", "remove it"});
  expect_words(error(R"([{"type": "area"}])"), {"lights[0].type", "'area'", "point, spot"});
  expect_words(error(R"([{"type": "spot", "spot": {"innerConeAngle": 0.6, "outerConeAngle": 0.5}}])"),
               {"lights[0].spot", "0.6", "0.5"});
  expect_words(error(R"([{"type": "spot", "spot": {"outerConeAngle": 2}}])"),
               {"lights[0].spot.outerConeAngle", "2 is outside"});
  expect_words(error(R"([{"type": "point", "intensity": -1}])"), {"lights[0].intensity", "-1 is outside"});
  expect_words(error(R"([{"type": "point", "color": [1, 1]}])"), {"lights[0].color", "3 numbers"});
  Triangle flat = with_lights(R"([{"type": "spot", "spot": {}}])");
  flat["/nodes/1/scale"] = {1, 1, 0};
  expect_words(error_of(flat.text()), {"nodes[1]", "no direction"});
}

TEST(GltfLights, LightsThatNoNodeHasAreNotLookedAt) {
  Triangle triangle = with_lights(R"([{"type": "directional"}])");
  triangle["/nodes"].erase(1);
  const SceneInput scene = gltf_files::read(triangle.text());
  EXPECT_TRUE(scene.luminaires.empty());
  EXPECT_FALSE(scene.units.has_value());
}

}  // namespace
}  // namespace fluxel::gltf_lights_test

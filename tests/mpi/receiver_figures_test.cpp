#include "output/receiver_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fluxel::receiver_figures_test {
namespace {

SensorLight cells(const std::vector<std::pair<double, double>>& values) {
  SensorLight light;
  for (const auto& [mean, error] : values) light.measured.sensors.push_back({Rgb(mean), Rgb(error), {}, {}});
  return light;
}

TEST(ReceiverFigures, OfWhiteLight) {
  const ReceiverFigures of = receiver_figures(cells({{300, 3}, {500, 4}, {400, 0}}), 0);
  EXPECT_NEAR(of.mean.value, 400, 1e-9);
  EXPECT_NEAR(of.mean.error, 5.0 / 3, 1e-9) << "cells err each for itself";
  EXPECT_NEAR(of.min.value, 300, 1e-9);
  EXPECT_NEAR(of.min.error, 3, 1e-9);
  EXPECT_NEAR(of.max.value, 500, 1e-9);
  EXPECT_NEAR(of.max.error, 4, 1e-9);
  ASSERT_TRUE(of.U0 && of.Ud);
  EXPECT_NEAR(of.U0->value, 0.75, 1e-9);
  EXPECT_NEAR(of.U0->error, 0.75 * std::hypot(3.0 / 300, 5.0 / 1200), 1e-9);
  EXPECT_NEAR(of.Ud->value, 0.6, 1e-9);
  EXPECT_NEAR(of.Ud->error, 0.6 * std::hypot(3.0 / 300, 4.0 / 500), 1e-9);
}

TEST(ReceiverFigures, TheSolutionsErrorIsNotLessInTheMean) {
  const ReceiverFigures of = receiver_figures(cells({{300, 0}, {500, 0}}), 0.02);
  EXPECT_NEAR(of.mean.error, 8, 1e-9);
  EXPECT_NEAR(of.min.error, 6, 1e-9);
  EXPECT_NEAR(of.U0->error, 0.75 * 0.02, 1e-9);
}

TEST(ReceiverFigures, ColoursCountByTheirLuminance) {
  SensorLight light;
  light.measured.sensors = {{{1, 0, 0}, {}, {}, {}}, {{0, 1, 0}, {}, {}, {}}};
  const ReceiverFigures of = receiver_figures(light, 0);
  EXPECT_NEAR(of.min.value, 0.2126, 1e-9);
  EXPECT_NEAR(of.max.value, 0.7152, 1e-9);
}

TEST(ReceiverFigures, DarknessHasNoUniformity) {
  const ReceiverFigures of = receiver_figures(cells({{0, 0}, {0, 0}}), 0.02);
  EXPECT_EQ(of.mean.value, 0);
  EXPECT_FALSE(of.U0);
  EXPECT_TRUE(figures_json(of)["Ud"].is_null());
}

}  // namespace
}  // namespace fluxel::receiver_figures_test

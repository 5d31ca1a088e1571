#include "output/receiver_figures.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace fluxel::receiver_figures_test {
namespace {

SensorLight cells(const std::vector<std::pair<double, double>>& values) {
  SensorLight light;
  for (const auto& [mean, error] : values)
    light.measured.sensors.push_back({Rgb(mean), Rgb(error), Rgb(mean), Rgb(mean)});
  return light;
}

/// Of a receiver that measures all of the cells.
ReceiverFigures figures_of(const SensorLight& light) {
  Receiver receiver;
  receiver.columns = static_cast<int>(light.measured.sensors.size());
  return receiver_figures(receiver, light);
}

TEST(ReceiverFigures, OfWhiteLight) {
  const ReceiverFigures of = figures_of(cells({{300, 3}, {500, 4}, {400, 0}}));
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

TEST(ReceiverFigures, ColoursCountByTheirLuminance) {
  SensorLight light;
  light.measured.sensors = {{{1, 0, 0}, {}, {1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {}, {0, 1, 0}, {0, 1, 0}}};
  const ReceiverFigures of = figures_of(light);
  EXPECT_NEAR(of.min.value, 0.2126, 1e-9);
  EXPECT_NEAR(of.max.value, 0.7152, 1e-9);
}

TEST(ReceiverFigures, NoiseOfManyCellsMakesNoUniformityLower) {
  // Even light, each cell with noise of 2 % by halves of 2.8 %.
  std::mt19937 random(7);
  std::normal_distribution<double> noise(100, 0.02 * std::numbers::sqrt2 * 100);
  SensorLight light;
  for (int k = 0; k < 10'000; ++k) {
    const double a = noise(random), b = noise(random);
    light.measured.sensors.push_back({Rgb(0.5 * (a + b)), Rgb(2), Rgb(a), Rgb(b)});
  }
  const ReceiverFigures of = figures_of(light);
  EXPECT_LT(of.min.value, 98) << "the least of so many is";
  EXPECT_LT(std::abs(of.U0->value - 1), 1.5 * of.U0->error);
  EXPECT_LT(std::abs(of.max.value - 100), 1.5 * of.max.error);
  EXPECT_LT(of.U0->error, 0.06);
}

TEST(ReceiverFigures, CellsThatAreLeftOutDoNotCount) {
  Receiver receiver;
  receiver.columns = 3;
  receiver.unmeasured = {0, 1, 0};
  const ReceiverFigures of = receiver_figures(receiver, cells({{300, 3}, {0, 0}, {500, 0}}));
  EXPECT_NEAR(of.mean.value, 400, 1e-9);
  EXPECT_NEAR(of.min.value, 300, 1e-9);
}

TEST(ReceiverFigures, CellsAreCountedByTheirErrors) {
  // 0.1 %, 1 % and 3 % of noise, darkness.
  const SensorLight light = cells({{1000, 1}, {100, 1}, {100, 3}, {0, 0}});
  const std::array<std::size_t, 8> noise{1, 0, 0, 1, 1, 0, 0, 1};
  EXPECT_EQ(figures_of(light).errors, noise);
}

TEST(ReceiverFigures, DarknessHasNoUniformity) {
  const ReceiverFigures of = figures_of(cells({{0, 0}, {0, 0}}));
  EXPECT_EQ(of.mean.value, 0);
  EXPECT_FALSE(of.U0);
  EXPECT_TRUE(figures_json(of)["ud"].is_null());
}

}  // namespace
}  // namespace fluxel::receiver_figures_test

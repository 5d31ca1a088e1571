#include "output/lighting_verdicts.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fluxel::lighting_verdicts_test {
namespace {

/// A receiver whose cells have a mean of 500 and a least value of 400, each with that error.
struct MeasuredDesk {
  Scene scene;
  std::vector<SensorLight> sensors;

  explicit MeasuredDesk(double error) {
    Receiver& desk = scene.receivers.emplace_back();
    desk.name = "desk";
    desk.columns = 2;
    SensorLight& light = sensors.emplace_back();
    light.receiver = "desk";
    light.measured.sensors = {{Rgb(400), Rgb(error), Rgb(400), Rgb(400)},
                              {Rgb(600), Rgb(error), Rgb(600), Rgb(600)}};
  }

  [[nodiscard]] TaskVerdict judge(double illuminance, std::optional<double> U0, double maintenance = 1) {
    scene.tasks = {{"task", "desk", "", "", illuminance, U0, {}, {}}};
    return judge_tasks(scene, stated_receivers(scene, sensors), {}, maintenance).front();
  }
};

TEST(LightingVerdicts, AreCertainBeyondTwoStandardErrors) {
  MeasuredDesk of(10);  // of the mean 10 / sqrt(2)
  EXPECT_EQ(of.judge(485, {}).verdict, Verdict::pass);
  EXPECT_EQ(of.judge(487, {}).verdict, Verdict::not_decided);
  EXPECT_EQ(of.judge(513, {}).verdict, Verdict::not_decided);
  EXPECT_EQ(of.judge(515, {}).verdict, Verdict::fail);
  EXPECT_EQ(MeasuredDesk(0).judge(500, {}).verdict, Verdict::pass) << "what is exact needs no margin";
}

TEST(LightingVerdicts, MaintenanceIsOfIlluminanceAlone) {
  MeasuredDesk of(1);
  const TaskVerdict verdict = of.judge(450, 0.75, 0.8);
  ASSERT_EQ(verdict.criteria.size(), 2u);
  EXPECT_NEAR(verdict.criteria[0].found->value, 400, 1e-9);
  EXPECT_NEAR(verdict.criteria[0].found->error, 0.8 / std::numbers::sqrt2, 1e-9);
  EXPECT_EQ(verdict.criteria[0].verdict, Verdict::fail);
  EXPECT_NEAR(verdict.criteria[1].found->value, 0.8, 1e-9);
  EXPECT_EQ(verdict.criteria[1].verdict, Verdict::pass);
  EXPECT_EQ(verdict.verdict, Verdict::fail);
}

TEST(LightingVerdicts, OneDoubtLeavesATaskUndecided) {
  MeasuredDesk of(1);
  EXPECT_EQ(of.judge(100, 0.8).verdict, Verdict::not_decided);
  EXPECT_EQ(of.judge(900, 0.8).verdict, Verdict::fail) << "a failure is one whatever else is in doubt";
}

TEST(LightingVerdicts, WhatWasNotMeasuredIsNotDecided) {
  Scene scene;
  scene.tasks = {{"task", "desk", "", "", 500, {}, 19.0, {"reader"}}};
  const TaskVerdict verdict = judge_tasks(scene, {}, {}, 1).front();
  ASSERT_EQ(verdict.criteria.size(), 2u);
  for (const Criterion& of : verdict.criteria) {
    EXPECT_FALSE(of.found);
    EXPECT_EQ(of.verdict, Verdict::not_decided);
  }
  EXPECT_EQ(verdict.verdict, Verdict::not_decided);
}

TEST(LightingVerdicts, WhatHasNotReachedItsErrorIsNotDecided) {
  MeasuredDesk of(1);
  of.sensors.front().measured.reached = false;
  EXPECT_EQ(of.judge(100, 0.1).verdict, Verdict::not_decided);
  EXPECT_EQ(of.judge(900, 0.9).verdict, Verdict::not_decided);
}

TEST(LightingVerdicts, BackgroundsAreTheEyesIndirectLight) {
  ObserverGlare glare{"reader", {}, 100 * std::numbers::pi, 3 * std::numbers::pi};
  glare.sources.weighted = 40000;
  const std::vector<ObserverGlare> eyes{glare};
  const ObserverRating of = observer_ratings(eyes).front();
  EXPECT_NEAR(of.background.value, 100, 1e-9);
  EXPECT_NEAR(of.background.error, 3, 1e-9);
  ASSERT_TRUE(of.rating);
  EXPECT_NEAR(of.rating->UGR, 16, 1e-9);
}

TEST(LightingVerdicts, AnEyeWithoutLightIsNotJudged) {
  MeasuredDesk of(1);
  of.scene.tasks = {{"task", "desk", "", "", 100, {}, 19.0, {"reader"}}};
  for (const double light : {0.0, 5.0}) {
    const std::vector<ObserverGlare> eyes{{"reader", {}, light, 0}};
    const TaskVerdict verdict =
        judge_tasks(of.scene, stated_receivers(of.scene, of.sensors), observer_ratings(eyes), 1).front();
    EXPECT_EQ(verdict.verdict, light > 0 ? Verdict::pass : Verdict::not_decided) << light;
  }
}

}  // namespace
}  // namespace fluxel::lighting_verdicts_test

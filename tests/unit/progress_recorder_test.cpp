#include "metrics/progress_recorder.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <future>
#include <vector>

#include "reference/estimation.hpp"
#include "tests/sampled_sensors.hpp"

namespace fluxel {
namespace {

/// Sensors that measure nothing much.
class Idle final : public SampledSensors {
 public:
  [[nodiscard]] std::size_t size() const override { return 40; }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }
  [[nodiscard]] Rgb sample(std::size_t /*sensor*/, OwenSobol /*numbers*/,
                           std::uint64_t& rays) const override {
    ++rays;
    return Rgb(1);
  }
};

// A disk that stands still until the work is done, which it must not wait for.
TEST(ProgressRecorder, NobodyWaitsForASlowKeep) {
  std::promise<void> worked;
  const std::shared_future<void> work = worked.get_future().share();
  std::atomic<int> kept = 0, in_vain = 0;
  NoDisplay display;
  ProgressRecorder recorder(
      display,
      [&](const std::vector<PhaseRecord>& records) {
        if (in_vain == 0 && work.wait_for(std::chrono::seconds(5)) != std::future_status::ready) ++in_vain;
        EXPECT_EQ(records.size(), 1u);
        ++kept;
      },
      std::chrono::milliseconds(0));
  const Idle sensors;
  const BlockedSensors mine = SensorBlocks::consecutive(sensors.size()).share(0, 1);
  Estimation estimation(sensors, mine, 1, Sampling::even);
  recorder.begin("elements");
  tbb::task_arena(2).execute([&] {
    estimation.add(std::vector{HalfSamples{4, 4}}, [&](double ready) { recorder.update(ready, 1); });
  });
  EXPECT_EQ(kept, 0);
  worked.set_value();
  recorder.end();
  EXPECT_EQ(recorder.records().size(), 1u);
  EXPECT_EQ(kept, 1) << "waited for before the records are given out; one call at a time";
  EXPECT_EQ(in_vain, 0);
}

TEST(ProgressRecorder, ErrorsAreShownBesideHowFarAPhaseIs) {
  struct Kept final : ProgressDisplay {
    std::string detail;
    void begin(const std::string& /*phase*/) override {}
    void show(double /*fraction*/, double /*seconds_left*/, const std::string& shown) override {
      detail = shown;
    }
    void end() override {}
  };
  Kept display;
  ProgressRecorder recorder(display);
  recorder.begin("refinement");
  recorder.update(1, 2, "of the pairs");
  EXPECT_EQ(display.detail, "of the pairs");
  recorder.update_error({1, 0.034, 0.01, ErrorLaw::sampling}, "7 rays");
  EXPECT_EQ(display.detail, "7 rays, error 3.4 % where 1 % is asked for");
  recorder.end();
  // What an earlier phase has come to stays in sight.
  recorder.reached(0.02);
  recorder.begin("refinement");
  recorder.update(1, 2, "of the pairs");
  EXPECT_EQ(display.detail, "of the pairs, error until now 2 %");
  recorder.end();
}

TEST(ProgressRecorder, WhatFailsToBeKeptIsTold) {
  NoDisplay display;
  ProgressRecorder recorder(
      display, [](const std::vector<PhaseRecord>&) { throw std::runtime_error("no disk"); },
      std::chrono::milliseconds(0));
  recorder.begin("phase");
  recorder.update(1, 2);
  EXPECT_THROW(static_cast<void>(recorder.records()), std::runtime_error);
}

}  // namespace
}  // namespace fluxel

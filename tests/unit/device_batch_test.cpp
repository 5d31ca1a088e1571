#include "reference/device_batch.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/error.hpp"
#include "reference/cuda/same_path.hpp"
#include "reference/estimation.hpp"
#include "reference/path_device.hpp"
#include "reference/receiver_sensors.hpp"
#include "tests/device_followers.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// A scene with sensors of each kind.
struct Measured {
  explicit Measured(const char* name) : view(test_scenes::load(name, 24, 17)) {
    for (const Piece& piece : scene.pieces)
      if (elements.size() < 90) elements.push_back({piece.outline, piece.patch});
    receiver.origin = {-0.1, 0.05, -0.1};
    receiver.u = {0, 0, 0.2};
    receiver.v = {0.2, 0.05, 0};
    receiver.columns = 9;
    receiver.rows = 10;
  }

  test_scenes::SceneOfFile view;
  const Scene& scene = view.scene;
  RayScene rays{scene, 1};
  LightPaths paths{rays};
  std::vector<ElementShape> elements;
  Receiver receiver;

  [[nodiscard]] std::unique_ptr<VerifiedPaths> device(std::size_t calls, bool faulty, double verified,
                                                      bool required) const {
    return std::make_unique<VerifiedPaths>(std::make_unique<TestFollower>(path_arrays(rays), calls, faulty),
                                           paths, verified, required);
  }
};

constexpr std::size_t kForEver = TestFollower::kForEver;

/// Numbers of samples that differ between blocks and halves, twice.
std::vector<HalfSamples> dealt(std::size_t blocks, std::uint32_t least) {
  std::vector<HalfSamples> samples;
  for (std::uint32_t k = 0; k < blocks; ++k) samples.push_back({least + 3 * (k % 4), least + 5 * (k % 3)});
  return samples;
}

void expect_same(const PathSensors& sensors, Sampling sampling, VerifiedPaths& device) {
  const BlockedSensors mine = SensorBlocks::consecutive(sensors.size()).share(0, 1);
  DeviceBatch batch(sensors, device);
  Estimation expected(sensors, mine, 3, sampling), found(sensors, mine, 3, sampling, &batch);
  for (const std::uint32_t least : {kMinSamples, 9u}) {
    double part = 0;
    const auto until = dealt(mine.ends.size(), least);
    expected.add(until, [](double) {});
    found.add(until, [&](double done) { part = done; });
    EXPECT_DOUBLE_EQ(part, 1);
  }
  EXPECT_EQ(found.rays(), expected.rays());
  std::size_t lit = 0;
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const SensorEstimate a = found.estimate(k), b = expected.estimate(k);
    EXPECT_TRUE(a.mean == b.mean && a.error == b.error && a.half_a == b.half_a && a.half_b == b.half_b) << k;
    lit += b.mean != Rgb(0) ? 1 : 0;
  }
  EXPECT_GT(lit, sensors.size() / 3);
  for (std::size_t block = 0; block < mine.ends.size(); ++block)
    EXPECT_EQ(found.spread(block, 4).variance, expected.spread(block, 4).variance) << block;
}

TEST(DeviceBatch, EstimatesAreThoseOfTheProcessorToTheBit) {
  for (const char* name : {"cornell-box", "office-2391"}) {
    const Measured of(name);
    const auto elements = element_sensors(of.paths, of.scene, of.elements);
    const auto area = pixel_sensors(of.paths, of.scene, of.view.camera, 0);
    const auto points = pixel_sensors(of.paths, of.scene, of.view.camera, 2);
    const auto cells = receiver_sensors(of.paths, of.receiver);
    for (const PathSensors* sensors : {elements.get(), area.get(), points.get(), cells.get()})
      for (const Sampling sampling : {Sampling::even, Sampling::blocks}) {
        SCOPED_TRACE(name);
        const auto device = of.device(kForEver, false, 0.1, true);
        expect_same(*sensors, sampling, *device);
        const VerifiedCounts& counts = device->counts();
        EXPECT_NEAR(static_cast<double>(counts.verified) / static_cast<double>(counts.made), 0.1, 0.02);
        EXPECT_EQ(counts.differing, 0u);
      }
  }
}

TEST(DeviceBatch, WhatIsWrongIsCounted) {
  const Measured of("cornell-box");
  const auto sensors = element_sensors(of.paths, of.scene, of.elements);
  const auto device = of.device(kForEver, true, 1, true);
  const BlockedSensors mine = SensorBlocks::consecutive(sensors->size()).share(0, 1);
  DeviceBatch batch(*sensors, *device);
  Estimation estimation(*sensors, mine, 3, Sampling::even, &batch);
  estimation.add(std::vector(mine.ends.size(), HalfSamples{16, 16}), [](double) {});
  const VerifiedCounts& counts = device->counts();
  EXPECT_EQ(counts.verified, counts.made);
  EXPECT_GT(counts.differing, counts.made / 4) << "those that are lit";
  EXPECT_LE(counts.differing, counts.made / 2 + 1);
  EXPECT_TRUE(differs_too_often(counts, cuda::kMostDifferingPaths));
  EXPECT_FALSE(differs_too_often({1000000, 100000, 100}, cuda::kMostDifferingPaths));
  EXPECT_FALSE(differs_too_often({100, 10, 8}, cuda::kMostDifferingPaths));
  EXPECT_TRUE(differs_too_often({1000000, 100000, 109}, cuda::kMostDifferingPaths));
}

TEST(DeviceBatch, WhereTheDeviceFailsTheProcessorGoesOn) {
  const Measured of("cornell-box");
  const auto sensors = pixel_sensors(of.paths, of.scene, of.view.camera, 0);
  const auto device = of.device(2, false, 0, false);
  expect_same(*sensors, Sampling::blocks, *device);
  EXPECT_EQ(device->failure(), "the GPU could not follow paths: planted");
  EXPECT_GT(device->counts().made, 0u);
  EXPECT_LE(device->counts().made, 2000u);
  const auto required = of.device(2, false, 0, true);
  EXPECT_THROW(expect_same(*sensors, Sampling::blocks, *required), InputError);
}

}  // namespace
}  // namespace fluxel

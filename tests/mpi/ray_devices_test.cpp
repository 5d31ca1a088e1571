#include "mpi_master/steps/ray_devices.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/reference_job.hpp"
#include "reference/path_device.hpp"
#include "small_scenes.hpp"
#include "tests/device_followers.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

/// Pixels of a scene, of which each of twelve ranks has a block, measured without and with such a device in
/// every second rank.
struct Pixels {
  SolveRequest request = scene_request("cornell-box", {"--resolution", "32x24"});
  Scene scene = scene_of(request);
  RayScene ray_scene{scene, 1};
  LightPaths paths{ray_scene};
  std::unique_ptr<PathSensors> sensors = pixel_sensors(paths, scene, *request.options.camera, 0);

  [[nodiscard]] std::unique_ptr<VerifiedPaths> device(std::size_t calls, bool faulty, bool required) const {
    if (world().rank() % 2 != 0) return nullptr;
    return std::make_unique<VerifiedPaths>(
        std::make_unique<TestFollower>(path_arrays(ray_scene), calls, faulty), paths, 1, required);
  }

  [[nodiscard]] ReferenceResult measured(VerifiedPaths* device) const {
    SilentProgress progress;
    std::optional<DeviceBatch> batch;
    if (device != nullptr) batch.emplace(*sensors, *device);
    const PathGoal goal{{{}, {}, 60000}, Sampling::blocks, 5};
    return measure(world(), *sensors, 20, goal, 2, progress, batch ? &*batch : nullptr);
  }

  [[nodiscard]] std::string refusal_of(VerifiedPaths* device) const {
    try {
      static_cast<void>(measured(device));
    } catch (const AgreedError& error) {
      return error.what();
    }
    return {};
  }
};

void expect_same(const ReferenceResult& found, const ReferenceResult& expected) {
  EXPECT_EQ(found.rays, expected.rays);
  EXPECT_EQ(found.mean, expected.mean);
  EXPECT_EQ(found.relative_error, expected.relative_error);
  ASSERT_EQ(found.sensors.size(), expected.sensors.size());
  for (std::size_t k = 0; k < found.sensors.size(); ++k) {
    ASSERT_EQ(found.sensors[k].mean, expected.sensors[k].mean) << k;
    ASSERT_EQ(found.sensors[k].error, expected.sensors[k].error) << k;
  }
}

constexpr std::size_t kForEver = TestFollower::kForEver;

TEST(PathDevices, FindTheSameLightInSomeRanks) {
  const Pixels pixels;
  const ReferenceResult expected = pixels.measured(nullptr);
  const auto device = pixels.device(kForEver, false, true);
  const ReferenceResult found = pixels.measured(device.get());
  expect_same(found, expected);
  EXPECT_EQ(expected.devices.made, 0u);
  EXPECT_GT(found.devices.made, 0u);
  EXPECT_EQ(found.devices.verified, found.devices.made);
  EXPECT_EQ(found.devices.differing, 0u);
}

TEST(PathDevices, WhatIsWrongEndsAllRanks) {
  const Pixels pixels;
  const auto device = pixels.device(kForEver, true, false);
  const std::string refusal = pixels.refusal_of(device.get());
  EXPECT_NE(refusal.find("a GPU and the processor differ in "), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("--device cpu"), std::string::npos) << refusal;
}

TEST(PathDevices, WhenOneFailsTheRankGoesOnWhereItMay) {
  const Pixels pixels;
  const auto device = pixels.device(1, false, false);
  expect_same(pixels.measured(device.get()), pixels.measured(nullptr));
  const std::vector<DeviceFailure> failures =
      device_failures_of_all(world(), device ? device->failure() : std::string());
  EXPECT_EQ(failures.size(), static_cast<std::size_t>((world().size() + 1) / 2)) << "all ranks know";
  const auto required = pixels.device(0, false, true);
  const std::string refusal = pixels.refusal_of(required.get());
  EXPECT_NE(refusal.find("planted (--device auto goes on without)"), std::string::npos) << refusal;
}

TEST(PathDevices, OnlyWhereTheyAreWanted) {
  const Pixels pixels;
  Options options = pixels.request.options;
  const auto find = [&] { return find_path_devices(world(), options, pixels.ray_scene, pixels.paths); };
  EXPECT_EQ(find().job.ranks, 0);
  EXPECT_TRUE(find().job.without.empty());
  options.device = Device::automatic;
  const PathDevices found = find();
  EXPECT_EQ(found.job.ranks + static_cast<int>(found.job.without.size()), world().size());
  if (found.job.ranks > 0) return;
  EXPECT_EQ(found.own, nullptr);
  options.device = Device::cuda;
  try {
    static_cast<void>(find());
    FAIL() << "there is no GPU";
  } catch (const AgreedError& error) {
    EXPECT_NE(std::string(error.what()).find("--device cuda: "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--device auto"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fluxel::test

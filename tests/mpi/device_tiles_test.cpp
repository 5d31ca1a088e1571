#include "mpi_master/steps/device_tiles.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "small_scenes.hpp"
#include "visibility/cuda/host_trace.hpp"
#include "visibility/device_scene.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

/// The GPU's code on the host, in parts as a GPU has them.
class HostDevice final : public cuda::TileDevice {
 public:
  static constexpr std::size_t kPart = 3;

  /// Fails when it has made so many tiles, and turns a bit of every tile where it is `faulty`.
  HostDevice(cuda::SceneArrays scene, std::size_t tiles_until_failure, bool faulty)
      : scene_(std::move(scene)), left_(tiles_until_failure), faulty_(faulty) {}

  void trace(const std::vector<cuda::TilePlace>& places, const Take& take) override {
    for (std::size_t first = 0; first < places.size(); first += kPart) {
      std::vector<cuda::TileResult> results;
      for (std::size_t k = first; k < std::min(first + kPart, places.size()); ++k) {
        if (left_ == 0) throw cuda::DeviceError("the GPU could not make tiles: planted");
        --left_;
        results.push_back(cuda::trace_on_host(scene_.view(), places[k]));
        if (faulty_ && results.back().facing > 0)
          results.back().part[3][2] = static_cast<std::uint16_t>(results.back().part[3][2] ^ 0x10u);
      }
      take(first, results.data(), results.size());
    }
  }

 private:
  cuda::SceneArrays scene_;
  std::size_t left_;
  bool faulty_;
};

constexpr std::size_t kForEver = ~std::size_t{0};

/// A scene, and what its visibility comes to without and with such a device in every second rank.
struct Devices {
  SolveRequest request = scene_request("cornell-box", {"--resolution", "32x32"});
  Scene scene = scene_of(request);
  SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  RayScene ray_scene{scene, 1};
  TileTracer tracer{ray_scene, subdivided.mesh.elements};
  RowCosts costs = RowCosts::even(tile_count(subdivided.mesh.elements.size()), 1e-4);
  std::vector<std::string> told;

  [[nodiscard]] Visibility without() {
    SilentProgress progress;
    return compute_visibility({world(), 2, progress}, tracer, costs);
  }

  [[nodiscard]] std::unique_ptr<DeviceTiles> device(std::size_t tiles_until_failure, bool faulty,
                                                    double verified, bool required) const {
    if (world().rank() % 2 != 0) return nullptr;
    return std::make_unique<DeviceTiles>(
        std::make_unique<HostDevice>(device_scene(ray_scene, subdivided.mesh.elements), tiles_until_failure,
                                     faulty),
        tracer, verified, required);
  }

  [[nodiscard]] Visibility with(DeviceTiles* device) {
    SilentProgress progress;
    Checkpoint checkpoint(world(), request.options, {}, [this](const std::string& s) { told.push_back(s); });
    return compute_visibility({world(), 2, progress}, tracer, costs, checkpoint, device);
  }

  /// Of a device that makes all tiles in its rank alone: which of them a rank of a job gets is a matter of
  /// its speed. Zeros in ranks without one.
  [[nodiscard]] DeviceCounts counts_of_all(bool faulty, double verified) const {
    const auto own = device(kForEver, faulty, verified, true);
    if (!own) return {};
    const TileTriangle triangle(costs.trace.size());
    std::vector<cuda::TilePlace> places;
    for (std::size_t row = 0; row < triangle.side(); ++row)
      for (std::size_t column = row; column < triangle.side(); ++column)
        places.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)});
    own->trace(places, [](std::size_t first, std::size_t count, const auto& tile) {
      for (std::size_t k = first; k < first + count; ++k) static_cast<void>(tile(k));
    });
    return own->counts();
  }
};

TEST(DeviceTiles, MakeTheSameBitsInSomeRanks) {
  Devices devices;
  const Visibility expected = devices.without();
  const auto device = devices.device(kForEver, false, 1, true);
  const Visibility found = devices.with(device.get());
  EXPECT_EQ(found.hash, expected.hash);
  EXPECT_EQ(found.makers, ranks() == 1 ? kMadeByGpu : kMadeByProcessor | kMadeByGpu);
  EXPECT_EQ(expected.makers, kMadeByProcessor);
  const std::uint64_t tiles = TileTriangle(devices.costs.trace.size()).size();
  EXPECT_GT(found.counts.device.tiles, 0u);
  EXPECT_LE(found.counts.device.tiles, tiles);
  if (ranks() == 1) {
    EXPECT_EQ(found.counts.device.tiles, tiles);
  }
  EXPECT_GT(found.counts.device.verified_pairs, found.counts.device.tiles * 64 * 32);
  EXPECT_EQ(found.counts.device.differing_bits, 0u);
  EXPECT_EQ(expected.counts.device.tiles, 0u);
}

TEST(DeviceTiles, WhatIsWrongIsCounted) {
  Devices devices;
  const auto device = devices.device(kForEver, true, 1, true);
  EXPECT_NE(devices.with(device.get()).hash, devices.without().hash);
  const DeviceCounts counts = devices.counts_of_all(true, 1);
  EXPECT_GE(counts.differing_bits, counts.tiles / 2);
  EXPECT_LE(counts.differing_bits, 2 * counts.tiles);
}

TEST(DeviceTiles, AShareIsVerified) {
  const Devices devices;
  const auto all = static_cast<double>(devices.counts_of_all(false, 1).verified_pairs);
  const auto quarter = static_cast<double>(devices.counts_of_all(false, 0.25).verified_pairs);
  EXPECT_GE(quarter, 0.15 * all);
  EXPECT_LE(quarter, 0.35 * all);
  EXPECT_EQ(devices.counts_of_all(false, 0).verified_pairs, 0u);
}

TEST(DeviceTiles, WhenOneFailsTheRankGoesOnAndNothingIsLost) {
  Devices devices;
  const std::uint64_t expected = devices.without().hash;
  // The tiles that tell the speed come first, twice. Then it fails in its second part, as a rank that has
  // little of a busy machine may get few tiles.
  const std::uint64_t tiles = TileTriangle(devices.costs.trace.size()).size();
  const auto device = devices.device(2 * tiles + HostDevice::kPart, false, 0, false);
  const Visibility found = devices.with(device.get());
  EXPECT_EQ(found.hash, expected);
  EXPECT_EQ(found.makers, kMadeByProcessor | kMadeByGpu);
  const auto devices_in_job = static_cast<std::uint64_t>((world().size() + 1) / 2);
  EXPECT_GT(found.counts.device.tiles, 0u);
  EXPECT_LE(found.counts.device.tiles, devices_in_job * HostDevice::kPart);
  ASSERT_GE(found.device_failures.size(), 1u) << "all ranks know";
  EXPECT_LE(found.device_failures.size(), devices_in_job);
  for (const DeviceFailure& failure : found.device_failures) {
    EXPECT_EQ(failure.rank % 2, 0) << "which ranks have one";
    EXPECT_EQ(failure.reason, "the GPU could not make tiles: planted");
  }
  EXPECT_TRUE(devices.told.empty()) << devices.told[0];
}

TEST(DeviceTiles, OneThatFailsAtTheStartIsDoneWithout) {
  Devices devices;
  const std::uint64_t expected = devices.without().hash;
  const auto device = devices.device(0, false, 0, false);
  EXPECT_EQ(devices.with(device.get()).hash, expected);
}

TEST(DeviceTiles, OnlyWhereTheyAreWanted) {
  Devices devices;
  Options options = devices.request.options;
  options.device = Device::cpu;
  const auto find = [&] {
    return find_tile_devices(world(), options, devices.ray_scene, devices.subdivided.mesh.elements,
                             devices.tracer);
  };
  EXPECT_EQ(find().job.ranks, 0);
  EXPECT_TRUE(find().job.without.empty());
  options.device = Device::automatic;
  const TileDevices found = find();
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

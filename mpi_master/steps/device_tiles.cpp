#include "mpi_master/steps/device_tiles.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <utility>

#include "core/hash.hpp"
#include "core/options.hpp"
#include "visibility/cuda/device_tracer.hpp"
#include "visibility/device_scene.hpp"
#include "visibility/tile_range.hpp"

namespace fluxel {

namespace {

/// Tiles that tell a GPU's speed: enough to keep the largest ones busy for a while.
constexpr std::size_t kSpeedTiles = 8192;

std::uint64_t different_bits(const TileBits& a, const TileBits& b) {
  std::uint64_t count = 0;
  for (std::size_t r = 0; r < kTileSize; ++r) count += static_cast<std::uint64_t>(std::popcount(a[r] ^ b[r]));
  return count;
}

/// The tile's number in [0, 1), spread evenly.
double spread(const cuda::TilePlace& place) {
  return 0x1p-64 * static_cast<double>(hash_bytes(std::as_bytes(std::span(&place, 1))));
}

}  // namespace

DeviceTiles::DeviceTiles(std::unique_ptr<cuda::TileDevice> device, const TileTracer& tracer, double verified,
                         bool required)
    : device_(std::move(device)), tracer_(tracer), verified_(verified), required_(required) {}

void DeviceTiles::trace(const std::vector<cuda::TilePlace>& places, const Take& take) {
  device_->trace(places, [&](std::size_t first, const cuda::TileResult* results, std::size_t count) {
    take(first, count, [&](std::size_t k) {
      TracedTile tile = traced_tile(results[k - first], places[k], tracer_.elements());
      if (is_verified(places[k])) verify(places[k], tile);
      return tile;
    });
    tiles_ += count;
  });
}

double DeviceTiles::speed(const RowCosts& costs) {
  const TileTriangle triangle(costs.trace.size());
  const std::size_t count = std::min<std::size_t>(kSpeedTiles, triangle.size());
  std::vector<cuda::TilePlace> places;
  double predicted = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t number = triangle.size() * k / count;
    const std::size_t row = triangle.row_of(number);
    places.push_back(
        {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(triangle.column_of(row, number))});
    predicted += costs.trace[row] / static_cast<double>(triangle.side() - row);
  }
  const auto make = [&] { device_->trace(places, [](std::size_t, const cuda::TileResult*, std::size_t) {}); };
  try {
    make();  // the first time the driver gets ready
    const auto start = std::chrono::steady_clock::now();
    make();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return predicted / std::max(seconds, 1e-6);
  } catch (const cuda::DeviceError&) {
    return 1;
  }
}

bool DeviceTiles::is_verified(const cuda::TilePlace& place) const {
  return verified_ > 0 && spread(place) <= verified_;
}

void DeviceTiles::verify(const cuda::TilePlace& place, const TracedTile& tile) {
  const TracedTile again = tracer_.trace(place.row, place.column);
  verified_pairs_ +=
      rows_of_tile(place.row, tracer_.elements()) * rows_of_tile(place.column, tracer_.elements());
  differing_bits_ += different_bits(tile.bits, again.bits);
}

TileDevices find_tile_devices(const Communicator& world, const Options& options, const RayScene& ray_scene,
                              std::span<const Element> elements, const TileTracer& tracer) {
  TileDevices devices;
  devices.job = find_job_devices(world, options.device, [&](const RankDevice& own) {
    auto device =
        std::make_unique<cuda::DeviceTracer>(device_scene(ray_scene, elements), own.number, own.memory);
    devices.own = std::make_unique<DeviceTiles>(std::move(device), tracer, options.verify_device,
                                                options.device == Device::cuda);
  });
  return devices;
}

}  // namespace fluxel

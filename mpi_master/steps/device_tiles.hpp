#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/scheduling/tile_sample.hpp"
#include "mpi_master/steps/rank_device.hpp"
#include "visibility/cuda/tile_device.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {

struct Options;

/// What GPUs had to do with the visibility.
struct DeviceCounts {
  std::uint64_t tiles = 0;           ///< made by them
  std::uint64_t verified_pairs = 0;  ///< of tiles that a processor has made again
  std::uint64_t differing_bits = 0;  ///< of these pairs
};

/// A rank's GPU, which makes tiles in place of a TileTracer; some of them the tracer makes again.
class DeviceTiles {
 public:
  /// Calls take(first, count, tile) for parts of a row of places, where tile(k) is the tile at place k, first
  /// <= k < first + count, and may be called from many threads at once.
  using Take = std::function<void(std::size_t first, std::size_t count,
                                  const std::function<TracedTile(std::size_t)>& tile)>;

  /// The tracer must outlive this. `verified`: the share of the tiles that it makes again; `required`: the
  /// rank may not go on without the device.
  DeviceTiles(std::unique_ptr<cuda::TileDevice> device, const TileTracer& tracer, double verified,
              bool required);

  [[nodiscard]] bool is_required() const { return required_; }

  /// Throws cuda::DeviceError; what has been taken until then is right.
  void trace(const std::vector<cuda::TilePlace>& places, const Take& take);

  /// Predicted processor time of tiles that are made in a second, from some of all parts of the matrix; 1
  /// where the device fails, which the next tiles will show again.
  [[nodiscard]] double speed(const RowCosts& costs);

  [[nodiscard]] DeviceCounts counts() const { return {tiles_, verified_pairs_, differing_bits_}; }

 private:
  [[nodiscard]] bool is_verified(const cuda::TilePlace& place) const;
  void verify(const cuda::TilePlace& place, const TracedTile& tile);

  std::unique_ptr<cuda::TileDevice> device_;
  const TileTracer& tracer_;
  double verified_;
  bool required_;
  std::uint64_t tiles_ = 0;
  std::atomic<std::uint64_t> verified_pairs_ = 0, differing_bits_ = 0;
};

/// The GPUs of a job that make tiles.
struct TileDevices {
  std::unique_ptr<DeviceTiles> own;  ///< of this rank, where it has one
  JobDevices job;
};

/// Collective: see find_job_devices.
[[nodiscard]] TileDevices find_tile_devices(const Communicator& world, const Options& options,
                                            const RayScene& ray_scene, std::span<const Element> elements,
                                            const TileTracer& tracer);

}  // namespace fluxel

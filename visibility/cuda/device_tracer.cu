#include "visibility/cuda/device_tracer.hpp"

#include <algorithm>
#include <string>

#include "visibility/cuda/scene_on_device.cuh"
#include "visibility/cuda/trace_group.hpp"

namespace fluxel::cuda {

namespace {

constexpr std::uint32_t kWarps = kGroupsOfTile * kGroupsOfTile;

/// A block of threads makes a tile, a warp a group of it.
__global__ void __launch_bounds__(kWarps* kLanes, 2)
    trace_tiles(TileScene scene, const TilePlace* places, TileResult* results) {
  __shared__ GroupMemory memory[kWarps];
  __shared__ std::uint32_t facing_sum, tested_sum;
  if (threadIdx.x == 0) facing_sum = tested_sum = 0;
  __syncthreads();
  const std::uint32_t group = threadIdx.x / kLanes;
  TileResult& result = results[blockIdx.x];
  PairCounts counts;
  trace_group(Warp(), scene, places[blockIdx.x], group, memory[group], result, counts);
  if (threadIdx.x % kLanes == 0) {
    atomicAdd(&facing_sum, counts.facing);
    atomicAdd(&tested_sum, counts.tested);
  }
  __syncthreads();
  if (threadIdx.x == 0) {
    result.facing = facing_sum;
    result.tested = tested_sum;
  }
}

/// Tiles of one launch: enough to fill the largest devices several times, and 2 MB of results.
constexpr std::size_t kTilesAtOnce = 4096;
/// Fewer would leave parts of a large device idle.
constexpr std::size_t kMinTilesAtOnce = 512;

/// One of the two buffers, and what works on it.
struct LaunchBuffer {
  Stream stream;
  Event begun, computed, sent;
  DeviceArray<TilePlace> places{kTilesAtOnce};
  DeviceArray<TileResult> results{kTilesAtOnce};
  PinnedArray<TilePlace> host_places{kTilesAtOnce};
  PinnedArray<TileResult> host_results{kTilesAtOnce};
  std::size_t first = 0, count = 0;
};

/// Throws before the device does, which would not say how much is missing.
void require_room(const SceneArrays& scene, std::size_t memory) {
  const std::size_t needed = scene.bytes() + 2 * kTilesAtOnce * (sizeof(TilePlace) + sizeof(TileResult));
  if (needed > memory)
    throw DeviceError("the scene needs " + megabytes(needed) +
                      " of the GPU's memory, and this rank may use " + megabytes(memory) +
                      " (use larger elements, fewer ranks a GPU, or --device cpu)");
}

}  // namespace

std::vector<DeviceProperties> find_devices(std::string& why_none) {
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess || count == 0) {
    cudaGetLastError();  // not to be met again
    why_none = std::string("no GPU can be used: ") +
               (error == cudaSuccess                   ? "the driver knows of none"
                : error == cudaErrorInsufficientDriver ? "there is no driver, or one too old for this program"
                                                       : cudaGetErrorString(error));
    return {};
  }
  std::vector<DeviceProperties> devices;
  for (int number = 0; number < count; ++number) {
    cudaDeviceProp properties{};
    check(cudaGetDeviceProperties(&properties, number), "be asked what it is");
    DeviceProperties found;
    found.name = properties.name;
    found.multiprocessors = properties.multiProcessorCount;
    found.major = properties.major;
    found.minor = properties.minor;
    found.id.assign(properties.uuid.bytes, sizeof properties.uuid.bytes);
    found.memory = properties.totalGlobalMem;
    devices.push_back(std::move(found));
  }
  return devices;
}

std::size_t free_memory_of(int device) {
  std::size_t free = 0, all = 0;
  check(cudaSetDevice(device), "be chosen");
  check(cudaMemGetInfo(&free, &all), "report its memory");
  return free;
}

struct DeviceTracer::State {
  int device;
  SceneOnDevice scene;
  LaunchBuffer buffers[2];
  DeviceSeconds seconds;

  State(const SceneArrays& arrays, int number) : device(number), scene(arrays) {}

  ~State() {
    for (const LaunchBuffer& buffer : buffers) cudaStreamSynchronize(buffer.stream.get());
  }

  /// Buffers may be written to until then, where a taker has thrown.
  void finish_interrupted() const {
    for (const LaunchBuffer& buffer : buffers)
      check(cudaStreamSynchronize(buffer.stream.get()), "end its work");
  }

  void start(LaunchBuffer& buffer, const std::vector<TilePlace>& places, std::size_t first,
             std::size_t most) {
    buffer.first = first;
    buffer.count = std::min(most, places.size() - first);
    std::copy_n(places.begin() + static_cast<std::ptrdiff_t>(first), buffer.count, buffer.host_places.data());
    buffer.begun.record(buffer.stream);
    check(cudaMemcpyAsync(buffer.places.data(), buffer.host_places.data(), buffer.count * sizeof(TilePlace),
                          cudaMemcpyHostToDevice, buffer.stream.get()),
          "take tiles");
    check(cudaMemsetAsync(buffer.results.data(), 0, buffer.count * sizeof(TileResult), buffer.stream.get()),
          "clear tiles");
    trace_tiles<<<static_cast<unsigned>(buffer.count), kWarps * kLanes, 0, buffer.stream.get()>>>(
        scene.view(), buffer.places.data(), buffer.results.data());
    check(cudaGetLastError(), "start on tiles");
    buffer.computed.record(buffer.stream);
    check(cudaMemcpyAsync(buffer.host_results.data(), buffer.results.data(),
                          buffer.count * sizeof(TileResult), cudaMemcpyDeviceToHost, buffer.stream.get()),
          "send tiles");
    buffer.sent.record(buffer.stream);
  }

  void finish(LaunchBuffer& buffer) {
    check(cudaStreamSynchronize(buffer.stream.get()), "make tiles");
    seconds.kernel += Event::seconds(buffer.begun, buffer.computed);
    seconds.transfer += Event::seconds(buffer.computed, buffer.sent);
  }
};

DeviceTracer::DeviceTracer(const SceneArrays& scene, int device, std::size_t memory) {
  check(cudaSetDevice(device), "be chosen");
  cudaFuncAttributes attributes{};
  check(cudaFuncGetAttributes(&attributes, trace_tiles), "run this program's code");
  require_room(scene, memory);
  state_ = std::make_unique<State>(scene, device);
}
DeviceTracer::~DeviceTracer() = default;

void DeviceTracer::trace(const std::vector<TilePlace>& places, const Take& take) {
  check(cudaSetDevice(state_->device), "be chosen");
  state_->finish_interrupted();
  // Several launches, so that the host has something to read while others are computed.
  const std::size_t most = std::clamp((places.size() + 3) / 4, kMinTilesAtOnce, kTilesAtOnce);
  const std::size_t parts = (places.size() + most - 1) / most;
  if (parts > 0) state_->start(state_->buffers[0], places, 0, most);
  for (std::size_t part = 0; part < parts; ++part) {
    if (part + 1 < parts) state_->start(state_->buffers[(part + 1) % 2], places, (part + 1) * most, most);
    LaunchBuffer& buffer = state_->buffers[part % 2];
    state_->finish(buffer);
    take(buffer.first, buffer.host_results.data(), buffer.count);
  }
}

const DeviceSeconds& DeviceTracer::seconds() const { return state_->seconds; }

}  // namespace fluxel::cuda

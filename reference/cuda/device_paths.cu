#include "reference/cuda/device_paths.hpp"

#include <algorithm>

#include "reference/cuda/light_path.hpp"
#include "visibility/cuda/scene_on_device.cuh"

namespace fluxel::cuda {

namespace {

/// Paths of a block: of as many sensors, or of fewer with several samples each.
constexpr unsigned kPathsOfBlock = 64;

/// A thread follows a path to its end.
__global__ void __launch_bounds__(kPathsOfBlock)
    follow_paths(PathScene scene, const PathBegin* paths, PathEstimate* found, std::size_t count) {
  const std::size_t k = std::size_t{blockIdx.x} * kPathsOfBlock + threadIdx.x;
  if (k < count) found[k] = LightPath(scene, paths[k]).follow();
}

constexpr std::size_t kBytesOfBlock = kPathsOfBlock * (sizeof(PathBegin) + sizeof(PathEstimate));
/// Enough to fill the largest devices many times, so that the last paths of a launch, which may be long, are
/// few beside all.
constexpr std::size_t kMaxBlocks = 1u << 15;

/// How many blocks there is memory for.
std::size_t blocks_in(std::size_t memory, const PathArrays& arrays) {
  const std::size_t left = memory - std::min(memory, arrays.bytes());
  const std::size_t blocks = std::min(kMaxBlocks, left / kBytesOfBlock);
  if (blocks == 0)
    throw DeviceError("the scene and a block of paths need " + megabytes(arrays.bytes() + kBytesOfBlock) +
                      " of the GPU's memory, and this rank may use " + megabytes(memory) +
                      " (use fewer ranks a GPU, or --device cpu)");
  return blocks;
}

}  // namespace

struct DevicePaths::State {
  int device;
  std::size_t most;  // paths
  SceneOnDevice rays;
  DeviceArray<std::uint8_t> flags;
  DeviceArray<PathSide> sides;
  DeviceArray<EmittingSide> emitters;
  DeviceArray<double> emitter_ends;
  DeviceArray<SobolDirections> directions;
  PathScene scene;
  Stream stream;
  Event begun, taken, computed, sent;
  DeviceArray<PathBegin> paths;
  DeviceArray<PathEstimate> found;
  DeviceSeconds seconds;

  State(const PathArrays& arrays, int number, std::size_t blocks)
      : device(number),
        most(blocks * kPathsOfBlock),
        rays(arrays.rays),
        flags(copy_to_device(arrays.flags)),
        sides(copy_to_device(arrays.sides)),
        emitters(copy_to_device(arrays.emitters)),
        emitter_ends(copy_to_device(arrays.emitter_ends)),
        directions(copy_to_device(arrays.directions)),
        scene(arrays.view()),
        paths(most),
        found(most) {
    scene.rays = rays.view();
    scene.flags = flags.data();
    scene.sides = sides.data();
    scene.emitters = emitters.data();
    scene.emitter_ends = emitter_ends.data();
    scene.directions = directions.data();
  }

  void follow(const PathBegin* begins, std::size_t count, PathEstimate* estimates) {
    begun.record(stream);
    check(cudaMemcpyAsync(paths.data(), begins, count * sizeof(PathBegin), cudaMemcpyHostToDevice,
                          stream.get()),
          "take paths");
    taken.record(stream);
    follow_paths<<<static_cast<unsigned>((count + kPathsOfBlock - 1) / kPathsOfBlock), kPathsOfBlock, 0,
                   stream.get()>>>(scene, paths.data(), found.data(), count);
    check(cudaGetLastError(), "start on paths");
    computed.record(stream);
    check(cudaMemcpyAsync(estimates, found.data(), count * sizeof(PathEstimate), cudaMemcpyDeviceToHost,
                          stream.get()),
          "send what paths have found");
    sent.record(stream);
    check(cudaStreamSynchronize(stream.get()), "follow paths");
    seconds.kernel += Event::seconds(taken, computed);
    seconds.transfer += Event::seconds(begun, taken) + Event::seconds(computed, sent);
  }
};

DevicePaths::DevicePaths(const PathArrays& arrays, int device, std::size_t memory) {
  const std::size_t blocks = blocks_in(memory, arrays);
  check(cudaSetDevice(device), "be chosen");
  cudaFuncAttributes attributes{};
  check(cudaFuncGetAttributes(&attributes, follow_paths), "run this program's code");
  state_ = std::make_unique<State>(arrays, device, blocks);
}
DevicePaths::~DevicePaths() = default;

std::size_t DevicePaths::paths_at_once() const { return state_->most; }

std::vector<PathEstimate> DevicePaths::follow(const std::vector<PathBegin>& paths) {
  check(cudaSetDevice(state_->device), "be chosen");
  std::vector<PathEstimate> found(paths.size());
  for (std::size_t first = 0; first < paths.size(); first += state_->most)
    state_->follow(paths.data() + first, std::min(state_->most, paths.size() - first), found.data() + first);
  return found;
}

DeviceSeconds DevicePaths::seconds() const { return state_->seconds; }

}  // namespace fluxel::cuda

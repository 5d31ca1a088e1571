#include "visibility/cuda/device_hits.hpp"

#include <algorithm>

#include "visibility/cuda/scene_on_device.cuh"

namespace fluxel::cuda {

namespace {

constexpr unsigned kThreads = 128;

/// A thread follows a ray: rays need not go the same way.
__global__ void __launch_bounds__(kThreads)
    find_hits(TileScene scene, const Ray* rays, NearestHit* hits, std::size_t count) {
  const std::size_t k = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  if (k < count) hits[k] = nearest_hit(scene, rays[k]);
}

/// Rays of one launch: enough to fill the largest devices several times, and 67 MB with their hits.
constexpr std::size_t kRaysAtOnce = 1u << 20;

}  // namespace

struct DeviceHits::State {
  int device;
  SceneOnDevice scene;
  Stream stream;
  Event begun, taken, computed, sent;
  DeviceArray<Ray> rays{kRaysAtOnce};
  DeviceArray<NearestHit> hits{kRaysAtOnce};
  PinnedArray<Ray> host_rays{kRaysAtOnce};
  PinnedArray<NearestHit> host_hits{kRaysAtOnce};
  DeviceSeconds seconds;

  State(const SceneArrays& arrays, int number) : device(number), scene(arrays) {}

  /// The hits of the rays that `host_rays` has, into `host_hits`.
  void find(std::size_t count) {
    begun.record(stream);
    check(cudaMemcpyAsync(rays.data(), host_rays.data(), count * sizeof(Ray), cudaMemcpyHostToDevice,
                          stream.get()),
          "take rays");
    taken.record(stream);
    find_hits<<<static_cast<unsigned>((count + kThreads - 1) / kThreads), kThreads, 0, stream.get()>>>(
        scene.view(), rays.data(), hits.data(), count);
    check(cudaGetLastError(), "start on rays");
    computed.record(stream);
    check(cudaMemcpyAsync(host_hits.data(), hits.data(), count * sizeof(NearestHit), cudaMemcpyDeviceToHost,
                          stream.get()),
          "send hits");
    sent.record(stream);
    check(cudaStreamSynchronize(stream.get()), "find hits");
    seconds.kernel += Event::seconds(taken, computed);
    seconds.transfer += Event::seconds(begun, taken) + Event::seconds(computed, sent);
  }
};

DeviceHits::DeviceHits(const SceneArrays& scene, int device, std::size_t memory) {
  const std::size_t needed = scene.bytes() + kRaysAtOnce * (sizeof(Ray) + sizeof(NearestHit));
  if (needed > memory)
    throw DeviceError("the scene and rays need " + megabytes(needed) + " of the GPU's memory, and " +
                      megabytes(memory) + " may be used");
  check(cudaSetDevice(device), "be chosen");
  cudaFuncAttributes attributes{};
  check(cudaFuncGetAttributes(&attributes, find_hits), "run this program's code");
  state_ = std::make_unique<State>(scene, device);
}
DeviceHits::~DeviceHits() = default;

std::size_t DeviceHits::rays_at_once() const { return kRaysAtOnce; }

std::vector<NearestHit> DeviceHits::find(const std::vector<Ray>& rays) {
  check(cudaSetDevice(state_->device), "be chosen");
  std::vector<NearestHit> hits(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
    std::copy_n(rays.data() + first, count, state_->host_rays.data());
    state_->find(count);
    std::copy_n(state_->host_hits.data(), count, hits.data() + first);
  }
  return hits;
}

DeviceSeconds DeviceHits::seconds() const { return state_->seconds; }

}  // namespace fluxel::cuda

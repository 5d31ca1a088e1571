#include "octree/cuda/device_octree.hpp"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include <algorithm>
#include <chrono>
#include <utility>

#include "octree/octree_builder.hpp"
#include "visibility/cuda/device_memory.cuh"

namespace fluxel::cuda {

namespace {

constexpr unsigned kThreads = 256;

template <class Pass>
__global__ void __launch_bounds__(kThreads) run_pass(Pass pass, std::size_t count) {
  const std::size_t k = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  if (k < count) pass(k);
}

/// Of a device's memory, what may still be taken [bytes].
struct Budget {
  std::size_t left;

  void take(std::size_t bytes) {
    if (bytes > left)
      throw DeviceError("the octree needs " + megabytes(bytes - left) +
                        " more of the GPU's memory than may be used");
    left -= bytes;
  }
};

/// An array on the device that is counted.
template <class T>
class CountedArray {
 public:
  CountedArray() = default;
  CountedArray(Budget& budget, std::size_t n) : budget_(&budget), size_(n) {
    budget.take(n * sizeof(T));
    try {
      items_ = DeviceArray<T>(n);
    } catch (...) {
      budget.left += n * sizeof(T);
      throw;
    }
  }
  ~CountedArray() {
    if (budget_ != nullptr) budget_->left += size_ * sizeof(T);
  }
  CountedArray(CountedArray&& other) noexcept { *this = std::move(other); }
  CountedArray& operator=(CountedArray&& other) noexcept {
    std::swap(items_, other.items_);
    std::swap(budget_, other.budget_);
    std::swap(size_, other.size_);
    return *this;
  }

  [[nodiscard]] T* data() const { return items_.data(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  DeviceArray<T> items_;
  Budget* budget_ = nullptr;
  std::size_t size_ = 0;
};

/// Runs an octree's passes on the device, one after another: see OctreeBuilder.
class DeviceMachine {
 public:
  template <class T>
  using Array = CountedArray<T>;

  explicit DeviceMachine(std::size_t memory) : budget_{memory} {}

  template <class T>
  [[nodiscard]] Array<T> array(std::size_t n) {
    return {budget_, n};
  }

  /// Twice as much where it is moved, so that it seldom is.
  template <class T>
  void grow(Array<T>& items, std::size_t n) {
    if (n <= items.size()) return;
    Array<T> larger(budget_, std::max(n, 2 * items.size()));
    copy(larger.data(), items.data(), items.size(), cudaMemcpyDeviceToDevice);
    wait();
    items = std::move(larger);
  }

  template <class Pass>
  void for_each(std::size_t n, const Pass& pass) {
    if (n == 0) return;
    run_pass<<<static_cast<unsigned>((n + kThreads - 1) / kThreads), kThreads, 0, stream_.get()>>>(pass, n);
    check(cudaGetLastError(), "start on an octree");
  }

  template <class T>
  [[nodiscard]] T sum_before(Array<T>& values, std::size_t n) {
    if (n == 0) return 0;
    const T last = at(values, n - 1);
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceScan::ExclusiveSum(scratch, bytes, values.data(), values.data(), n, stream_.get());
    });
    return at(values, n - 1) + last;
  }

  /// Stable, by the bits of the cubes' numbers alone.
  void sort(Array<OctreeReference>& references, std::size_t n, std::size_t cubes) {
    if (n == 0) return;
    int bits = 0;
    while (bits < 32 && std::size_t{1} << bits < cubes) ++bits;
    Array<OctreeReference> sorted(budget_, references.size());
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortKeys(scratch, bytes, references.data(), sorted.data(), n, 32,
                                            32 + bits, stream_.get());
    });
    // In their place, which passes know.
    copy(references.data(), sorted.data(), n, cudaMemcpyDeviceToDevice);
    wait();
  }

  template <class T>
  void copy(T* to, const T* from, std::size_t n, cudaMemcpyKind kind) {
    if (n == 0) return;
    check(cudaMemcpyAsync(to, from, n * sizeof(T), kind, stream_.get()), "copy an octree");
  }
  void wait() { check(cudaStreamSynchronize(stream_.get()), "make an octree"); }

 private:
  template <class T>
  [[nodiscard]] T at(const Array<T>& values, std::size_t k) {
    T value{};
    copy(&value, values.data() + k, 1, cudaMemcpyDeviceToHost);
    wait();
    return value;
  }

  /// Calls a function of CUB for the memory that it needs, and again with that.
  template <class Call>
  void with_scratch(const Call& call) {
    std::size_t bytes = 0;
    check(call(nullptr, bytes), "tell what an octree needs");
    const Array<unsigned char> scratch(budget_, bytes);
    check(call(scratch.data(), bytes), "sum up or sort an octree");
    wait();
  }

  Budget budget_;
  Stream stream_;
};

template <class T>
std::vector<T> copy_to_host(DeviceMachine& machine, const CountedArray<T>& items, std::size_t n) {
  std::vector<T> copy(n);
  machine.copy(copy.data(), items.data(), n, cudaMemcpyDeviceToHost);
  machine.wait();
  return copy;
}

template <class T>
CountedArray<T> copy_from_host(DeviceMachine& machine, const std::vector<T>& items) {
  CountedArray<T> copy = machine.array<T>(items.size());
  machine.copy(copy.data(), items.data(), items.size(), cudaMemcpyHostToDevice);
  machine.wait();
  return copy;
}

/// Adds the time that something takes, which waits for the device.
template <class Work>
void time_work(double& seconds, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct DeviceOctree::State {
  int device;
  mutable DeviceMachine machine;
  OctreeFrame frame;
  CountedArray<Sphere> spheres;
  CountedArray<OctreeNode> nodes;
  CountedArray<std::uint32_t> references;
  std::size_t node_count = 0, reference_count = 0;
  mutable DeviceSeconds seconds;

  State(const std::vector<Sphere>& items, int number, std::size_t memory)
      : device(number), machine(memory), frame(frame_of(items.data(), items.size())) {
    time_work(seconds.transfer, [&] { spheres = copy_from_host(machine, items); });
    time_work(seconds.kernel, [&] {
      OctreeBuilder<DeviceMachine> builder(machine, spheres.data(), items.size(), frame);
      builder.build();
      machine.wait();
      nodes = std::move(builder.nodes());
      references = std::move(builder.references());
      node_count = builder.node_count();
      reference_count = builder.reference_count();
    });
  }
};

DeviceOctree::DeviceOctree(const std::vector<Sphere>& spheres, int device, std::size_t memory) {
  check(cudaSetDevice(device), "be chosen");
  cudaFuncAttributes attributes{};
  check(cudaFuncGetAttributes(&attributes, run_pass<octree_pass::Test>), "run this program's code");
  state_ = std::make_unique<State>(spheres, device, memory);
}
DeviceOctree::~DeviceOctree() = default;

OctreeArrays DeviceOctree::arrays() const {
  check(cudaSetDevice(state_->device), "be chosen");
  OctreeArrays arrays;
  arrays.frame = state_->frame;
  time_work(state_->seconds.transfer, [&] {
    arrays.nodes = copy_to_host(state_->machine, state_->nodes, state_->node_count);
    arrays.references = copy_to_host(state_->machine, state_->references, state_->reference_count);
  });
  return arrays;
}

HoldingSpheres DeviceOctree::find(const std::vector<OctreePoint>& points) {
  check(cudaSetDevice(state_->device), "be chosen");
  DeviceMachine& machine = state_->machine;
  CountedArray<OctreePoint> taken;
  time_work(state_->seconds.transfer, [&] { taken = copy_from_host(machine, points); });
  CountedArray<std::uint32_t> first, found;
  std::uint32_t count = 0;
  time_work(state_->seconds.kernel, [&] {
    const OctreeView tree = state_->frame.view(state_->nodes.data(), state_->references.data());
    count = look_up(machine, OctreeLookUp{tree, state_->spheres.data(), taken.data(), nullptr, nullptr},
                    points.size(), first, found);
    machine.wait();
  });
  HoldingSpheres holding;
  time_work(state_->seconds.transfer, [&] {
    holding.first = copy_to_host(machine, first, points.size());
    holding.spheres = copy_to_host(machine, found, count);
  });
  holding.first.push_back(count);
  return holding;
}

DeviceSeconds DeviceOctree::seconds() const { return state_->seconds; }

}  // namespace fluxel::cuda

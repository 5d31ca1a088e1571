#pragma once

#include <cuda_runtime.h>

#include <string>
#include <utility>
#include <vector>

#include "visibility/cuda/device.hpp"

namespace fluxel::cuda {

/// Throws DeviceError with what was tried and the driver's reason.
inline void check(cudaError_t error, const char* tried) {
  if (error == cudaSuccess) return;
  cudaGetLastError();  // not to be met again by the next kernel, which may be another object's
  std::string reason = cudaGetErrorString(error);
  if (error == cudaErrorNoKernelImageForDevice || error == cudaErrorUnsupportedPtxVersion)
    reason += " (the program was built for devices of compute capability " FLUXEL_CUDA_ARCHITECTURES
              "; configure with -DCMAKE_CUDA_ARCHITECTURES of this one)";
  throw DeviceError(std::string("the GPU could not ") + tried + ": " + reason);
}

/// An array in the memory of the device or, pinned so that the device can write to it, of the host.
template <class Item, cudaError_t (*allocate)(void**, std::size_t), cudaError_t (*release)(void*)>
class CudaArray {
 public:
  CudaArray() = default;
  explicit CudaArray(std::size_t size) {
    if (size == 0) return;
    void* memory = nullptr;
    check(allocate(&memory, size * sizeof(Item)), "give memory");
    data_ = static_cast<Item*>(memory);
  }
  ~CudaArray() {
    if (data_ != nullptr) release(data_);
  }
  CudaArray(CudaArray&& other) noexcept : data_(std::exchange(other.data_, nullptr)) {}
  CudaArray& operator=(CudaArray&& other) noexcept {
    std::swap(data_, other.data_);
    return *this;
  }

  [[nodiscard]] Item* data() const { return data_; }

 private:
  Item* data_ = nullptr;
};

inline cudaError_t allocate_on_device(void** memory, std::size_t bytes) { return cudaMalloc(memory, bytes); }
inline cudaError_t release_on_device(void* memory) { return cudaFree(memory); }
inline cudaError_t allocate_pinned(void** memory, std::size_t bytes) { return cudaMallocHost(memory, bytes); }
inline cudaError_t release_pinned(void* memory) { return cudaFreeHost(memory); }

template <class Item>
using DeviceArray = CudaArray<Item, allocate_on_device, release_on_device>;
template <class Item>
using PinnedArray = CudaArray<Item, allocate_pinned, release_pinned>;

/// A copy on the device, there for all streams: a copy from memory that is not pinned may return before it
/// is, and streams that do not block do not wait for it.
template <class Item>
DeviceArray<Item> copy_to_device(const std::vector<Item>& items) {
  DeviceArray<Item> array(items.size());
  if (items.empty()) return array;
  check(cudaMemcpy(array.data(), items.data(), items.size() * sizeof(Item), cudaMemcpyHostToDevice),
        "take the scene");
  check(cudaStreamSynchronize(cudaStreamLegacy), "take the scene");
  return array;
}

class Stream {
 public:
  Stream() { check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "make a stream"); }
  ~Stream() {
    if (stream_ != nullptr) cudaStreamDestroy(stream_);
  }
  Stream(Stream&& other) noexcept : stream_(std::exchange(other.stream_, nullptr)) {}
  Stream& operator=(Stream&&) = delete;

  [[nodiscard]] cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

class Event {
 public:
  Event() { check(cudaEventCreate(&event_), "make an event"); }
  ~Event() {
    if (event_ != nullptr) cudaEventDestroy(event_);
  }
  Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
  Event& operator=(Event&&) = delete;

  void record(const Stream& stream) { check(cudaEventRecord(event_, stream.get()), "record an event"); }

  /// Until what was recorded last has happened; not at all where nothing was.
  void wait() { check(cudaEventSynchronize(event_), "finish what it was asked for"); }

  /// [s], between two events that have happened.
  [[nodiscard]] static double seconds(const Event& first, const Event& second) {
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, first.event_, second.event_), "tell the time");
    return 1e-3 * static_cast<double>(milliseconds);
  }

 private:
  cudaEvent_t event_ = nullptr;
};

}  // namespace fluxel::cuda

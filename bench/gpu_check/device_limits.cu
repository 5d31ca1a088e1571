#include "bench/gpu_check/device_limits.hpp"

#include <algorithm>

#include "visibility/cuda/device_memory.cuh"

namespace fluxel::cuda::checks {

namespace {

constexpr std::size_t kCopied = 256u << 20u;  // bytes: far more than any cache holds
constexpr int kCopies = 10;

/// [bytes/s], the best of some copies.
double copy_speed(void* to, const void* from, cudaMemcpyKind kind) {
  Stream stream;
  Event begun, done;
  double best = 0;
  for (int copy = 0; copy < kCopies; ++copy) {
    begun.record(stream);
    check(cudaMemcpyAsync(to, from, kCopied, kind, stream.get()), "copy");
    done.record(stream);
    check(cudaStreamSynchronize(stream.get()), "copy");
    best = std::max(best, static_cast<double>(kCopied) / Event::seconds(begun, done));
  }
  return best;
}

int attribute(cudaDeviceAttr name, int device) {
  int value = 0;
  check(cudaDeviceGetAttribute(&value, name, device), "be asked what it is");
  return value;
}

/// Of a multiprocessor, in single precision and in double (CUDA C++ programming guide, throughput of native
/// arithmetic instructions).
struct Lanes {
  int in_single, in_double;
};

Lanes lanes_of(int major, int minor) {
  if (major == 7) return {64, minor == 0 ? 32 : 2};
  if (major == 8 && minor == 0) return {64, 32};
  if (major == 9 || (major == 10 && minor == 0)) return {128, 64};
  return {128, 2};
}

}  // namespace

DeviceLimits limits_of(int device) {
  check(cudaSetDevice(device), "be chosen");
  const DeviceArray<char> a(kCopied), b(kCopied);
  const PinnedArray<char> host(kCopied);
  DeviceLimits limits;
  limits.copy_on_device = 2 * copy_speed(b.data(), a.data(), cudaMemcpyDeviceToDevice);
  limits.copy_to_device = copy_speed(a.data(), host.data(), cudaMemcpyHostToDevice);
  limits.copy_to_host = copy_speed(host.data(), a.data(), cudaMemcpyDeviceToHost);
  const double hertz = 1e3 * attribute(cudaDevAttrClockRate, device);
  const Lanes lanes = lanes_of(attribute(cudaDevAttrComputeCapabilityMajor, device),
                               attribute(cudaDevAttrComputeCapabilityMinor, device));
  const double multiprocessors = attribute(cudaDevAttrMultiProcessorCount, device);
  limits.single_operations = multiprocessors * lanes.in_single * hertz;
  limits.double_operations = multiprocessors * lanes.in_double * hertz;
  return limits;
}

}  // namespace fluxel::cuda::checks

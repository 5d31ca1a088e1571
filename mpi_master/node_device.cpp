#include "mpi_master/node_device.hpp"

#include <vector>

#include "visibility/cuda/device.hpp"

namespace fluxel {

namespace {

/// Of a GPU's free memory, for all ranks that use it: drivers and other programs need some.
constexpr double kMemoryShare = 0.9;

}  // namespace

std::string device_failure_of(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const cuda::DeviceError& error) {
    return error.what();
  }
}

NodeDevice find_node_device(const Communicator& node) {
  NodeDevice own;
  std::vector<cuda::DeviceFacts> devices;
  const std::string failure = device_failure_of([&] { devices = cuda::find_devices(own.why_not); });
  if (!failure.empty()) own.why_not = failure;
  // All ranks of a node have asked for what is free before any takes of it.
  node.barrier();
  if (devices.empty()) return own;
  const auto rank = static_cast<std::size_t>(node.rank()), ranks = static_cast<std::size_t>(node.size());
  const std::size_t number = rank % devices.size();
  const std::size_t sharing = (ranks - number + devices.size() - 1) / devices.size();
  own.number = static_cast<int>(number);
  own.name = devices[number].name;
  own.memory = static_cast<std::size_t>(kMemoryShare * static_cast<double>(devices[number].free_memory) /
                                        static_cast<double>(sharing));
  return own;
}

}  // namespace fluxel

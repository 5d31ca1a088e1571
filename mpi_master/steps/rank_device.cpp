#include "mpi_master/steps/rank_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/texts.hpp"
#include "visibility/cuda/device.hpp"

namespace fluxel {

namespace {

/// Of a GPU's free memory, for all ranks that use it: drivers and other programs need some.
constexpr double kMemoryShare = 0.9;

/// Of a device's id [bytes].
constexpr std::size_t kIdSize = 16;

}  // namespace

std::string device_failure_of(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const cuda::DeviceError& error) {
    return error.what();
  }
}

std::vector<DeviceFailure> device_failures_of_all(const Communicator& communicator, const std::string& own) {
  const std::vector<std::string> reasons = texts_of_all(communicator, {own});
  std::vector<DeviceFailure> failures;
  for (std::size_t rank = 0; rank < reasons.size(); ++rank)
    if (!reasons[rank].empty()) failures.push_back({static_cast<int>(rank), reasons[rank]});
  return failures;
}

RankDevice find_rank_device(const Communicator& host) {
  RankDevice own;
  std::vector<cuda::DeviceProperties> devices;
  const std::string failure = device_failure_of([&] { devices = cuda::find_devices(own.why_not); });
  if (!failure.empty()) own.why_not = failure;
  std::array<char, kIdSize> id{};
  if (!devices.empty()) {
    const std::size_t number = static_cast<std::size_t>(host.rank()) % devices.size();
    own.number = static_cast<int>(number);
    // The first use, for which the driver takes memory, too. Other devices are left alone.
    own.why_not = device_failure_of([&] { static_cast<void>(cuda::free_memory_of(own.number)); });
    if (own.why_not.empty()) {
      own.name = devices[number].name;
      std::ranges::copy(devices[number].id, id.begin());
    }
  }
  // Ranks may each be shown a device of their own, which is number 0 to all.
  const std::vector<char> ids = host.all_gather(std::span<const char>(id));
  if (own.found()) own.why_not = device_failure_of([&] { own.memory = cuda::free_memory_of(own.number); });
  // All ranks of a host have asked for what is free before any takes of it.
  host.barrier();
  if (!own.why_not.empty()) own.name.clear();
  std::size_t sharing = 0;
  for (std::size_t at = 0; at < ids.size(); at += kIdSize)
    if (std::equal(id.begin(), id.end(), ids.begin() + static_cast<std::ptrdiff_t>(at))) ++sharing;
  own.memory =
      static_cast<std::size_t>(kMemoryShare * static_cast<double>(own.memory) / static_cast<double>(sharing));
  return own;
}

JobDevices find_job_devices(const Communicator& world, Device wanted,
                            const std::function<void(const RankDevice&)>& take) {
  if (wanted == Device::cpu) return {};
  RankDevice own = find_rank_device(world.host());
  if (own.found()) own.why_not = device_failure_of([&] { take(own); });
  agree(world, [&] {
    if (wanted == Device::cuda && !own.why_not.empty())
      throw InputError(fmt::format("--device cuda: {} (--device auto goes on without)", own.why_not));
  });
  JobDevices job;
  job.without = device_failures_of_all(world, own.why_not);
  job.ranks = world.size() - static_cast<int>(job.without.size());
  std::vector<std::string> names;
  if (own.why_not.empty()) names.push_back(own.name);
  job.names = texts_of_all(world, names);
  std::ranges::sort(job.names);
  job.names.erase(std::unique(job.names.begin(), job.names.end()), job.names.end());
  return job;
}

}  // namespace fluxel

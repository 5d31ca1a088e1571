#include "mpi_master/communication/machine.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <span>

namespace fluxel {

namespace {

/// Fixed in size, so that it can be gathered as it is.
struct PlaceRecord {
  std::array<char, 256> host{};
  cpu_set_t cpus{};
  cpu_set_t usable{};  ///< what it could have been bound to
  bool one_core = false;
};

/// The CPUs that this process may have, whatever its launcher has bound it to: of a set of all, the kernel
/// grants those of the control group.
cpu_set_t usable_cpus(const cpu_set_t& bound) {
  cpu_set_t all, usable = bound;
  std::memset(&all, 0xff, sizeof all);
  if (sched_setaffinity(0, sizeof all, &all) != 0) return bound;
  sched_getaffinity(0, sizeof usable, &usable);
  sched_setaffinity(0, sizeof bound, &bound);
  return usable;
}

/// The hardware threads of the core that a CPU is of, as the kernel lists them.
std::string core_of(int cpu) {
  std::ifstream stream(fmt::format("/sys/devices/system/cpu/cpu{}/topology/thread_siblings_list", cpu));
  std::string siblings;
  return stream >> siblings ? siblings : fmt::format("{}", cpu);
}

bool is_one_core(const cpu_set_t& cpus) {
  std::optional<std::string> core;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &cpus)) continue;
    if (!core) core = core_of(cpu);
    if (core_of(cpu) != *core) return false;
  }
  return true;
}

PlaceRecord my_place() {
  PlaceRecord place;
  gethostname(place.host.data(), place.host.size() - 1);
  CPU_ZERO(&place.cpus);
  sched_getaffinity(0, sizeof place.cpus, &place.cpus);
  place.usable = usable_cpus(place.cpus);
  place.one_core = is_one_core(place.cpus);
  return place;
}

/// The ranks of one host.
struct HostRecord {
  cpu_set_t usable{}, bound{};
  int ranks = 0;
  std::map<std::string, int> ranks_with;  ///< a CPU set, as cpu_list writes it

  void add(const PlaceRecord& record, const std::string& cpus) {
    CPU_OR(&usable, &usable, &record.usable);
    CPU_OR(&usable, &usable, &record.cpus);
    CPU_OR(&bound, &bound, &record.cpus);
    ++ranks;
    ++ranks_with[cpus];
  }
};

std::string cpu_list(const cpu_set_t& cpus) {
  std::string text;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &cpus)) continue;
    int last = cpu;
    while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &cpus)) ++last;
    if (!text.empty()) text += ',';
    text += last > cpu ? fmt::format("{}-{}", cpu, last) : fmt::format("{}", cpu);
    cpu = last;
  }
  return text;
}

/// The number after `key` in a file of lines such as "MemAvailable:   12345 kB", or 0.
std::uint64_t named_number(const std::filesystem::path& file, const std::string& key) {
  std::ifstream stream(file);
  std::string word;
  while (stream >> word) {
    std::uint64_t value = 0;
    if (word == key && stream >> value) return value;
    stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return 0;
}

std::uint64_t number_in(const std::filesystem::path& file, std::uint64_t otherwise) {
  std::ifstream stream(file);
  std::uint64_t value = 0;
  return stream >> value ? value : otherwise;
}

/// The control groups (version 2) that this process stands in, its own and those above.
std::vector<std::filesystem::path> control_groups() {
  const std::filesystem::path root = "/sys/fs/cgroup";
  std::ifstream stream("/proc/self/cgroup");
  std::vector<std::filesystem::path> groups{root};
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("0::/")) continue;
    std::filesystem::path below = root;
    for (const auto& part : std::filesystem::path(line.substr(4))) groups.push_back(below /= part);
  }
  return groups;
}

}  // namespace

std::vector<RankPlace> rank_places(const Communicator& communicator, int threads) {
  const PlaceRecord mine = my_place();
  const auto records = communicator.all_gather(std::span(&mine, 1));
  std::map<std::string, HostRecord> hosts;
  for (const PlaceRecord& record : records) hosts[record.host.data()].add(record, cpu_list(record.cpus));
  std::vector<RankPlace> places;
  for (const PlaceRecord& record : records) {
    const HostRecord& host = hosts.at(record.host.data());
    const std::string cpus = cpu_list(record.cpus);
    const int cpu_count = CPU_COUNT(&record.cpus);
    places.push_back({.host = record.host.data(),
                      .cpus = cpus,
                      .threads = threads > 0 ? threads : std::max(1, cpu_count / host.ranks_with.at(cpus)),
                      .ranks_on_host = host.ranks,
                      .cpu_count = cpu_count,
                      .one_core = record.one_core,
                      .idle_cpus_on_host = CPU_COUNT(&host.usable) - CPU_COUNT(&host.bound)});
  }
  return places;
}

double all_processor_seconds(const Communicator& communicator) {
  auto microseconds = static_cast<std::uint64_t>(1e6 * processor_seconds());
  communicator.all_sum(std::span(&microseconds, 1));
  return 1e-6 * static_cast<double>(microseconds);
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t peak_resident_bytes() {
  if (const std::uint64_t own = named_number("/proc/self/status", "VmHWM:"); own > 0) return 1024 * own;
  // Includes that of what the process was forked from.
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t proportional_bytes() { return 1024 * named_number("/proc/self/smaps_rollup", "Pss:"); }

std::uint64_t bytes_left_in_group(const std::filesystem::path& folder) {
  constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t limit = number_in(folder / "memory.max", kUnlimited);
  if (limit == kUnlimited) return kUnlimited;
  const std::uint64_t charged = number_in(folder / "memory.current", 0);
  // Files that nobody reads any more are charged too, and given up as soon as memory is wanted.
  const std::uint64_t reclaimable = named_number(folder / "memory.stat", "inactive_file");
  const std::uint64_t used = charged - std::min(charged, reclaimable);
  return limit - std::min(limit, used);
}

std::uint64_t available_bytes(int ranks_on_host) {
  const auto ranks = static_cast<std::uint64_t>(ranks_on_host);
  std::uint64_t available = 1024 * named_number("/proc/meminfo", "MemAvailable:") / ranks;
  for (const std::filesystem::path& group : control_groups())
    available = std::min(available, bytes_left_in_group(group) / ranks);
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const std::uint64_t used = 1024 * named_number("/proc/self/status", "VmSize:");
    available = std::min(available, limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used));
  }
  return available;
}

AvailableBytes available_here(const Communicator& communicator) {
  const std::vector<RankPlace> places = rank_places(communicator, 1);
  const int ranks = places[static_cast<std::size_t>(communicator.rank())].ranks_on_host;
  return [ranks] { return available_bytes(ranks); };
}

}  // namespace fluxel

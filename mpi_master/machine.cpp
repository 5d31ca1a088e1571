#include "mpi_master/machine.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

namespace fluxel {

namespace {

/// Fixed in size, so that it can be gathered as it is.
struct PlaceRecord {
  std::array<char, 256> host{};
  cpu_set_t cpus{};
};

PlaceRecord my_place() {
  PlaceRecord place;
  gethostname(place.host.data(), place.host.size() - 1);
  CPU_ZERO(&place.cpus);
  sched_getaffinity(0, sizeof place.cpus, &place.cpus);
  return place;
}

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
  std::vector<RankPlace> places;
  for (const PlaceRecord& record : records) {
    const auto on_host = [&](const PlaceRecord& other) {
      return std::strcmp(other.host.data(), record.host.data()) == 0;
    };
    const auto same_cpus = [&](const PlaceRecord& other) {
      return on_host(other) && CPU_EQUAL(&other.cpus, &record.cpus) != 0;
    };
    const auto sharing = static_cast<int>(std::ranges::count_if(records, same_cpus));
    places.push_back({record.host.data(), cpu_list(record.cpus),
                      threads > 0 ? threads : std::max(1, CPU_COUNT(&record.cpus) / sharing),
                      static_cast<int>(std::ranges::count_if(records, on_host))});
  }
  return places;
}

std::vector<std::string> launch_warnings(const std::vector<RankPlace>& places, int threads_asked) {
  std::vector<std::string> warnings;
  const RankPlace& first = places.front();
  const auto online = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  const bool one_cpu = first.cpus.find_first_of(",-") == std::string::npos;
  if (one_cpu && first.ranks_on_host < online)
    warnings.push_back(fmt::format(
        "each rank is bound to one CPU while {} of {} on {} have no rank; start with --bind-to none, or "
        "--map-by ppr:1:numa:pe=K for K CPUs a rank",
        online - first.ranks_on_host, online, first.host));
  if (one_cpu && threads_asked > 1)
    warnings.push_back(
        fmt::format("{} threads share one CPU because the launcher bound the rank to it; start "
                    "with --bind-to none",
                    threads_asked));
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "SLURM_NTASKS"}) {
    const char* said = std::getenv(variable);
    const int ranks = said != nullptr ? std::atoi(said) : 0;
    if (ranks > 1 && places.size() == 1)
      warnings.push_back(
          fmt::format("{}={} but this is a job of one rank: the launcher's MPI is not the one that Fluxel "
                      "was built with, and every copy computes everything",
                      variable, ranks));
  }
  return warnings;
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
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

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

}  // namespace fluxel

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

/// The value in bytes of a line such as "MemAvailable:   12345 kB".
std::uint64_t proc_kilobytes(const char* file, const std::string& key) {
  std::ifstream stream(file);
  std::string word;
  while (stream >> word) {
    std::uint64_t kilobytes = 0;
    if (word == key + ":" && stream >> kilobytes) return kilobytes * 1024;
    stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return 0;
}

std::uint64_t number_in(const char* file, std::uint64_t otherwise) {
  std::ifstream stream(file);
  std::uint64_t value = 0;
  return stream >> value ? value : otherwise;
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
                      "was built with, "
                      "and every copy computes everything",
                      variable, ranks));
  }
  return warnings;
}

std::uint64_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t available_bytes(int ranks_on_host) {
  constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
  const auto ranks = static_cast<std::uint64_t>(ranks_on_host);
  std::uint64_t available = proc_kilobytes("/proc/meminfo", "MemAvailable") / ranks;
  const std::uint64_t group_limit = number_in("/sys/fs/cgroup/memory.max", kUnlimited);
  if (group_limit != kUnlimited) {
    const std::uint64_t group_used = number_in("/sys/fs/cgroup/memory.current", 0);
    available = std::min(available, (group_limit - std::min(group_limit, group_used)) / ranks);
  }
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const std::uint64_t used = proc_kilobytes("/proc/self/status", "VmSize");
    available = std::min(available, limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used));
  }
  return available;
}

}  // namespace fluxel

#include "mpi_master/communication/launch_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <optional>
#include <set>

namespace fluxel {

namespace {

constexpr const char* kAdvice =
    "start with --bind-to none, or for K CPUs a rank with --map-by ppr:1:numa:pe=K (mpirun) or "
    "--cpus-per-task=K (srun)";

using Places = std::vector<RankPlace>;

Places select(const Places& places, const std::function<bool(const RankPlace&)>& condition) {
  Places selected;
  std::ranges::copy_if(places, std::back_inserter(selected), condition);
  return selected;
}

/// ", and on 2 other hosts", or nothing where all are on the first one's.
std::string and_other_hosts(const Places& places) {
  std::set<std::string> hosts;
  for (const RankPlace& place : places) hosts.insert(place.host);
  const std::size_t others = hosts.size() - 1;
  return others == 0 ? "" : fmt::format(", and on {} other host{}", others, others == 1 ? "" : "s");
}

std::string cpus(int number) { return number == 1 ? "1 CPU" : fmt::format("{} CPUs", number); }

void warn_of_binding(const Places& places, int threads_asked, std::vector<std::string>& warnings) {
  const Places narrow =
      select(places, [](const RankPlace& place) { return place.one_core && place.idle_cpus_on_host > 0; });
  if (!narrow.empty())
    warnings.push_back(fmt::format("ranks are bound to one core each while CPUs idle: {} on {}{}; {}",
                                   cpus(narrow.front().idle_cpus_on_host), narrow.front().host,
                                   and_other_hosts(narrow), kAdvice));
  const Places crowded = select(places, [&](const RankPlace& place) {
    return threads_asked > place.cpu_count && place.idle_cpus_on_host > 0;
  });
  if (!crowded.empty())
    warnings.push_back(fmt::format(
        "{} threads of a rank share {} on {}{}, because the launcher bound it there while others idle; {}",
        threads_asked, cpus(crowded.front().cpu_count), crowded.front().host, and_other_hosts(crowded),
        kAdvice));
}

struct LauncherWord {
  const char* variable;
  int value;
};

/// The first of these variables that is set. A launcher inside another stands before it.
std::optional<LauncherWord> launcher_word(std::initializer_list<const char*> variables) {
  for (const char* variable : variables)
    if (const char* text = std::getenv(variable)) return LauncherWord{variable, std::atoi(text)};
  return std::nullopt;
}

/// A job of one rank among several copies: Open MPI, MPICH and its kin (PMI) and Slurm say how many they
/// started, and those that say only which one this is (PMIx) tell all but the first. SLURM_NTASKS is no
/// such word: it is the size of a batch job, also where a single program runs in it.
void warn_of_copies(std::vector<std::string>& warnings) {
  auto word = launcher_word({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"});
  const int least = word ? 2 : 1;
  if (!word) word = launcher_word({"PMIX_RANK"});
  if (!word || word->value < least) return;
  warnings.push_back(
      fmt::format("{}={} but this is a job of one rank: the launcher's MPI is not the one that "
                  "Fluxel was built with, and every copy computes everything",
                  word->variable, word->value));
}

}  // namespace

std::vector<std::string> launch_warnings(const std::vector<RankPlace>& places, int threads_asked) {
  std::vector<std::string> warnings;
  warn_of_binding(places, threads_asked, warnings);
  if (places.size() == 1) warn_of_copies(warnings);
  return warnings;
}

}  // namespace fluxel

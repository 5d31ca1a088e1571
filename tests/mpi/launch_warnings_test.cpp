#include "mpi_master/communication/launch_warnings.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>
#include <string>

#include "app/rank_list.hpp"
#include "mpi_master/communication/launcher.hpp"

namespace fluxel::test {
namespace {

RankPlace unbound(const std::string& host) { return {host, "0-3", 2, 2, 4, false, 0}; }
RankPlace bound(const std::string& host, const std::string& cpu, int idle) {
  return {host, cpu, 1, 2, 1, true, idle};
}

using Variables = std::map<std::string, std::string>;

/// The launcher's variables as a test wants them, up to the end of the scope.
class LauncherEnvironment {
 public:
  explicit LauncherEnvironment(const Variables& values) {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "SLURM_STEP_NUM_TASKS",
                             "SLURM_NTASKS", "OMPI_COMM_WORLD_RANK", "PMI_RANK", "SLURM_PROCID",
                             "FLUX_TASK_RANK", "OMPI_MCA_pml", "OMPI_MCA_ess_singleton_isolated"}) {
      const char* value = std::getenv(name);
      before_[name] = value != nullptr ? std::optional<std::string>(value) : std::nullopt;
      unsetenv(name);
    }
    for (const auto& [name, value] : values) setenv(name.c_str(), value.c_str(), 1);
  }
  ~LauncherEnvironment() {
    for (const auto& [name, value] : before_)
      value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
  }
  LauncherEnvironment(const LauncherEnvironment&) = delete;
  LauncherEnvironment& operator=(const LauncherEnvironment&) = delete;

 private:
  std::map<std::string, std::optional<std::string>> before_;
};

TEST(LaunchWarnings, NothingIsSaidOfRanksThatUseTheMachine) {
  EXPECT_TRUE(launch_warnings({unbound("a"), unbound("a")}, 0).empty());
  EXPECT_TRUE(launch_warnings({unbound("a"), unbound("a")}, 8).empty()) << "nobody bound them";
  EXPECT_TRUE(launch_warnings({bound("a", "0", 0), bound("a", "1", 0)}, 0).empty()) << "no CPU is left over";
}

TEST(LaunchWarnings, RanksBoundToACoreAreNamedWithTheHost) {
  const auto warnings = launch_warnings({bound("a", "0", 2), bound("a", "1", 2)}, 0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("ranks are bound to one core each while CPUs idle: 2 CPUs on a; start"))
      << warnings[0];
  EXPECT_NE(warnings[0].find("--bind-to none"), std::string::npos);
}

TEST(LaunchWarnings, AnyHostIsLookedAt) {
  const auto warnings = launch_warnings(
      {unbound("a"), unbound("a"), bound("b", "0", 1), bound("b", "1", 1), bound("c", "0", 3)}, 0);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(": 1 CPU on b, and on 1 other host;"), std::string::npos) << warnings[0];
}

TEST(LaunchWarnings, ThreadsThatShareTheCpusOfABoundRankAreCounted) {
  const auto warnings = launch_warnings({unbound("a"), bound("b", "0", 3)}, 4);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_TRUE(warnings[1].starts_with("4 threads of a rank share 1 CPU on b,")) << warnings[1];
}

TEST(LaunchWarnings, CopiesThatKnowOfNoOtherAreNamed) {
  const auto copies = [](const Variables& values) {
    const LauncherEnvironment environment(values);
    return launch_warnings({unbound("a")}, 0);
  };
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const auto warnings = copies({{variable, "4"}});
    ASSERT_EQ(warnings.size(), 1u) << variable;
    EXPECT_TRUE(warnings[0].starts_with(std::string(variable) + "=4 but this is a job of one rank"));
    EXPECT_TRUE(copies({{variable, "1"}, {"PMIX_RANK", "0"}}).empty()) << variable;
  }
  EXPECT_TRUE(copies({}).empty());
  EXPECT_EQ(copies({{"PMIX_RANK", "1"}}).size(), 1u);
  EXPECT_TRUE(copies({{"PMIX_RANK", "0"}}).empty()) << "it may be the only one";
  EXPECT_TRUE(copies({{"SLURM_NTASKS", "4"}}).empty()) << "a single program in a batch job of four";
  EXPECT_TRUE(copies({{"OMPI_COMM_WORLD_SIZE", "1"}, {"SLURM_STEP_NUM_TASKS", "4"}}).empty())
      << "mpirun -np 1 within a step of Slurm";
}

TEST(LaunchWarnings, JobsOfSeveralRanksAreNoCopies) {
  const LauncherEnvironment environment(Variables{{"OMPI_COMM_WORLD_SIZE", "2"}});
  EXPECT_TRUE(launch_warnings({unbound("a"), unbound("a")}, 0).empty());
}

TEST(FoldNames, NumbersInARowShareBrackets) {
  EXPECT_EQ(fold_names({"vm"}), "vm");
  EXPECT_EQ(fold_names({"n08", "n09", "n10", "login"}), "n[08-10],login");
  EXPECT_EQ(fold_names({"n9", "n10", "m11"}), "n9,n10,m11") << "of different length or stem";
  EXPECT_EQ(fold_names({"n2", "n1"}), "n2,n1") << "in their order";
  EXPECT_EQ(fold_names({"ip-10-0-0-1", "ip-10-0-0-2"}), "ip-10-0-0-[1-2]");
  EXPECT_EQ(fold_names({"n99999999999999999998", "n99999999999999999999"}),
            "n99999999999999999998,n99999999999999999999");
}

TEST(Launcher, RanksAreKnownByAnyLauncher) {
  for (const char* name :
       {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID", "FLUX_TASK_RANK"}) {
    const LauncherEnvironment environment(Variables{{name, "3"}});
    EXPECT_EQ(rank_by_launcher(), 3) << name;
  }
  const LauncherEnvironment none(Variables{});
  EXPECT_EQ(rank_by_launcher(), std::nullopt);
}

TEST(Launcher, OnlyAProcessWithoutOneStartsAlone) {
  const auto pml = [] {
    const char* value = std::getenv("OMPI_MCA_pml");
    return value != nullptr ? std::string(value) : std::string();
  };
  {
    const LauncherEnvironment environment(Variables{{"PMIX_RANK", "0"}});
    start_alone();
    EXPECT_EQ(pml(), "");
  }
  {
    const LauncherEnvironment environment(Variables{{"OMPI_MCA_pml", "cm"}});
    start_alone();
    EXPECT_EQ(pml(), "cm") << "what the user has set stays";
  }
  const LauncherEnvironment environment(Variables{});
  start_alone();
  EXPECT_EQ(pml(), "ob1");
}

TEST(RankList, RanksOfAHostShareALine) {
  EXPECT_EQ(rank_list({{"vm", "0-1", 1}, {"vm", "0-1", 1}}),
            std::vector<std::string>{"ranks 0-1 on vm: 2 ranks with CPUs 0-1, 1 thread each"});
  EXPECT_EQ(rank_list({{"vm", "0", 1}}), std::vector<std::string>{"rank 0 on vm: CPUs 0, 1 thread"});
}

TEST(RankList, HundredsOfRanksAreAFewLines) {
  std::vector<RankPlace> places;
  for (int host = 1; host <= 100; ++host)
    for (int domain = 0; domain < 2; ++domain)
      places.push_back({fmt::format("n{:03}", host), domain == 0 ? "0-7" : "8-15", host == 50 ? 4 : 8});
  EXPECT_EQ(
      rank_list(places),
      (std::vector<std::string>{
          "ranks 0-97,100-199 on n[001-049],n[051-100]: on each CPUs 0-7, 8 threads; CPUs 8-15, 8 threads",
          "ranks 98-99 on n050: CPUs 0-7, 4 threads; CPUs 8-15, 4 threads"}));
}

TEST(RankList, RanksDealtRoundTheHostsAreToldApartFromRanksInBlocks) {
  EXPECT_EQ(rank_list({{"a", "0-1", 1}, {"b", "0", 1}, {"a", "0-1", 1}, {"b", "0", 1}}),
            (std::vector<std::string>{"ranks 0,2 on a: 2 ranks with CPUs 0-1, 1 thread each",
                                      "ranks 1,3 on b: 2 ranks with CPUs 0, 1 thread each"}));
}

}  // namespace
}  // namespace fluxel::test

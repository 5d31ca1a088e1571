#include "app/solve.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/options.hpp"
#include "host_shapes.hpp"
#include "method/methods.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "small_scenes.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

namespace fs = std::filesystem;

/// A folder of the root that all ranks know of and that goes with the test.
class SharedFolder {
 public:
  SharedFolder() {
    Bytes name;
    if (world().is_root()) {
      std::string pattern = (fs::temp_directory_path() / "fluxel-mpi-XXXXXX").string();
      if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
      const auto bytes = std::as_bytes(std::span(pattern));
      name.assign(bytes.begin(), bytes.end());
    }
    world().broadcast(name);
    path_ = std::string(reinterpret_cast<const char*>(name.data()), name.size());
  }
  ~SharedFolder() {
    std::error_code ignored;
    if (world().is_root()) fs::remove_all(path_, ignored);
  }
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What report.json says under error_estimate.
std::string estimate_in(const fs::path& folder) {
  const std::string report = content(folder / "report.json");
  const std::size_t first = report.find("\"error_estimate\"");
  return first == std::string::npos ? "" : report.substr(first, report.find('}', first) - first);
}

int solve(SolveRequest request, const fs::path& out, const Communicator& ranks = world()) {
  request.options.out = out.string();
  request.options.quiet = true;
  request.options.threads = 1;
  NoDisplay display;
  if (!ranks.is_root()) request.input = {};
  const int code = run_solve(ranks, request, display);
  world().barrier();
  return code;
}

TEST(Methods, RemediesNameOptionsThatTheMethodKnows) {
  for (const MethodRow& row : kMethods)
    for (const std::string_view remedy : {row.remedies.against_defect, row.remedies.against_growth})
      for (std::size_t at = remedy.find("--"); at != remedy.npos; at = remedy.find("--", at + 2)) {
        const std::string_view rest = remedy.substr(at + 2);
        EXPECT_TRUE(row.knows(rest.substr(0, rest.find_first_of(" ,)")))) << row.name << ": " << remedy;
      }
}

TEST(Solve, WritesPictureSolutionAndReport) {
  const SharedFolder folder;
  EXPECT_EQ(solve(scene_request("cornell-box", {"--resolution", "16x16"}), folder.path()), 0);
  for (const char* file : {"image.exr", "image.png", "solution.ply", "report.json", "report.html"})
    EXPECT_GT(content(folder.path() / file).size(), 100u) << file;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 6)
      << "these and convergence.csv";
  world().barrier();  // the folder goes when the root is done
}

TEST(Solve, MoreRanksThanPatches) {
  const SharedFolder folder;
  EXPECT_EQ(solve(two_squares(), folder.path()), 0);
  EXPECT_NE(content(folder.path() / "report.json").find("\"elements\": 2"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder.path() / "image.png")) << "there is no camera";
  world().barrier();
}

TEST(Solve, ThreeWhereItDoesNotConverge) {
  const SharedFolder folder;
  SolveRequest request = scene_request("emitting-wall", {"--resolution", "8x8", "--max-iterations", "1"});
  EXPECT_EQ(solve(request, folder.path()), 3);
  EXPECT_TRUE(fs::exists(folder.path() / "solution.ply"));
  EXPECT_NE(content(folder.path() / "report.json").find("\"converged\": false"), std::string::npos);
  world().barrier();
}

TEST(Solve, HasTheSameBytesOnAnyHosts) {
  // In three channels and in one, unknowns on one side and on two, and shots before the solve.
  const std::vector<SolveRequest> requests{
      scene_request("cornell-box", {"--resolution", "16x16", "--preview"}),
      scene_request("construction-in-wood",
                    {"--resolution", "12x12", "--sides", "two", "--max-edge", "1", "--form-factor", "disc"}),
      scene_request("emitting-wall", {"--resolution", "8x8", "--solver", "southwell"})};
  std::vector<std::string> of_one_host;
  for (const HostShape& shape : host_shapes()) {
    for (std::size_t k = 0; k < requests.size(); ++k) {
      SCOPED_TRACE(shape.name + ", " + requests[k].input.name);
      const SharedFolder folder;
      EXPECT_EQ(solve(requests[k], folder.path(), shape.world), 0);
      const std::string estimate = estimate_in(folder.path());
      EXPECT_NE(estimate.find("discretisation_rgb"), std::string::npos) << estimate;
      const std::string solution = content(folder.path() / "solution.ply") + estimate;
      if (of_one_host.size() == k) of_one_host.push_back(solution);
      EXPECT_TRUE(solution == of_one_host[k]);
      world().barrier();
    }
  }
}

TEST(Solve, AllRanksOfAllHostsKnowThatItDoesNotConverge) {
  const SolveRequest request =
      scene_request("emitting-wall", {"--resolution", "8x8", "--max-iterations", "1"});
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    const SharedFolder folder;
    EXPECT_EQ(solve(request, folder.path(), shape.world), 3);
  }
}

TEST(Solve, ADryRunLeavesTheReportAndItsPageAlone) {
  const SharedFolder folder;
  EXPECT_EQ(solve(scene_request("cornell-box", {"--resolution", "16x16", "--dry-run"}), folder.path()), 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
  EXPECT_TRUE(fs::exists(folder.path() / "report.json"));
  EXPECT_TRUE(fs::exists(folder.path() / "report.html"));
  world().barrier();
}

TEST(Solve, TheFolderHoldsOneRunsFiles) {
  const SharedFolder folder;
  EXPECT_EQ(solve(scene_request("cornell-box", {"--resolution", "16x16"}), folder.path()), 0);
  EXPECT_EQ(solve(scene_request("cornell-box", {"--resolution", "16x16", "--dry-run"}), folder.path()), 0);
  EXPECT_TRUE(fs::exists(folder.path() / "image.png")) << "a dry run removes nothing";
  EXPECT_NE(content(folder.path() / "report.json").find("earlier run"), std::string::npos);
  world().barrier();
  EXPECT_EQ(solve(two_squares(), folder.path()), 0);
  for (const char* file : {"image.exr", "image.png"}) EXPECT_FALSE(fs::exists(folder.path() / file)) << file;
  EXPECT_TRUE(fs::exists(folder.path() / "solution.ply"));
  EXPECT_TRUE(fs::exists(folder.path() / "report.json"));
  world().barrier();
}

TEST(Solve, AFolderInThePlaceOfAFileIsFoundBeforeTheWork) {
  const SharedFolder folder;
  if (world().is_root()) fs::create_directory(folder.path() / "solution.ply");
  EXPECT_THROW(solve(two_squares(), folder.path()), AgreedError);
  EXPECT_FALSE(fs::exists(folder.path() / "report.json"));
  world().barrier();
}

TEST(Solve, AFolderThatCannotBeMadeIsEverybodysError) {
  EXPECT_THROW(solve(two_squares(), "/proc/nope"), AgreedError);
}

TEST(Solve, ASceneWithoutLightIsEverybodysError) {
  const SharedFolder folder;
  SolveRequest dark = two_squares();
  for (InputMaterial& material : dark.input.materials) material.Ke = Rgb(0);
  EXPECT_THROW(solve(dark, folder.path()), AgreedError);
}

}  // namespace
}  // namespace fluxel::test

#include "method/kept_links.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "core/hash.hpp"
#include "core/options.hpp"
#include "hierarchy/kept_rounds.hpp"
#include "hierarchy/link_hierarchy.hpp"
#include "method/handle_signals.hpp"
#include "method/hierarchy_statistics.hpp"
#include "mpi_master/checkpoint/round_folder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

namespace fluxel {

namespace fs = std::filesystem;

namespace {

/// Of links of a scene and the radiosity that they have led to, as single precision holds it.
std::uint64_t identity_of(std::uint64_t scene, std::span<const Rgb> B) {
  std::vector<float> stored;
  stored.reserve(3 * B.size());
  for (const Rgb& value : B)
    for (int c = 0; c < 3; ++c) stored.push_back(static_cast<float>(value[c]));
  return hash_bytes(std::as_bytes(std::span(stored)), scene);
}

}  // namespace

fs::path links_folder(const fs::path& solution_folder) { return solution_folder / "links"; }

std::uint64_t scene_of_links(const Problem& problem, const Hierarchy& hierarchy) {
  const NodeTree& tree = hierarchy.tree();
  return rounds_identity(problem.ray_scene, tree, LeafUnknowns(tree).unknowns(), {}, {});
}

void keep_links(const Problem& problem, const Hierarchy& hierarchy, std::uint64_t scene,
                const std::vector<HierarchyRound>& rounds, std::span<const Rgb> B) {
  const fs::path folder = links_folder(problem.options.out);
  std::uint64_t identity = 0;
  on_root(problem.world, [&] {
    identity = identity_of(scene, B);
    RoundFolder::remove(folder);
    std::error_code ignored;  // what cannot be written is warned of
    fs::create_directories(folder, ignored);
  });
  problem.world.all_sum(std::span(&identity, 1));  // the others have 0
  const auto warn = [&](const std::string& sentence) { problem.log.warn(sentence); };
  RoundFolder::of_solution(problem.world, folder, identity, warn).keep(hierarchy, rounds, {});
}

std::unique_ptr<Hierarchy> take_up_links(const Problem& problem, std::span<const Rgb> B) {
  const fs::path folder = links_folder(fs::path(problem.options.solution).parent_path());
  std::uint64_t stands = 0;
  on_root(problem.world, [&] {
    std::error_code failed;
    stands = fs::is_directory(folder, failed) || failed == std::errc::permission_denied ? 1 : 0;
  });
  problem.world.all_sum(std::span(&stands, 1));
  if (stands == 0) return nullptr;
  auto hierarchy = std::make_unique<LinkHierarchy>(ranks_of(problem.world), problem.scene, problem.ray_scene,
                                                   problem.threads, OracleParts{.importance = false});
  hierarchy->handle_signals_by([&problem] { handle_signals(problem.world, problem.options, problem.log); });
  const std::uint64_t identity = identity_of(scene_of_links(problem, *hierarchy), B);
  bool has_warned = false;
  const auto warn = [&](const std::string& sentence) {
    problem.log.warn(sentence);
    has_warned = true;
  };
  AuditPaths none;
  const std::vector<HierarchyRound> rounds =
      RoundFolder::of_solution(problem.world, folder, identity, warn).restore(*hierarchy, none);
  if (rounds.empty()) {
    if (!has_warned && problem.world.is_root())
      problem.log.warn(fmt::format("{} holds no whole round of {}: pictures are gathered by rays",
                                   folder.string(), problem.options.solution));
    return nullptr;
  }
  problem.log.say(fmt::format("light by {}, kept in {}", exchange_text(rounds.back()), folder.string()));
  return hierarchy;
}

}  // namespace fluxel

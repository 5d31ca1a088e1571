#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/audit_paths.hpp"
#include "hierarchy/hierarchy.hpp"
#include "hierarchy/hierarchy_round.hpp"
#include "mpi_master/checkpoint/checkpoint.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

struct Options;

/// The last finished round of a hierarchy on disk: every rank has a file of its links, and when all of these
/// stand there the root writes the file that names them. Until then the round before stands there whole.
class RoundFolder {
 public:
  /// Called on the root alone.
  using Warn = std::function<void(const std::string&)>;

  /// A job that keeps nothing.
  RoundFolder() = default;

  /// Collective, by the options checkpoint and resume. Throws AgreedError where the folder cannot be used, or
  /// has rounds of this identity (see rounds_identity) and is not to be resumed. `warn` is called on the root
  /// alone.
  RoundFolder(const Communicator& communicator, const Options& options, std::uint64_t identity, Warn warn);

  /// A folder that holds the rounds of one solution alone; files that cannot be read are warned of.
  /// Collective.
  [[nodiscard]] static RoundFolder of_solution(const Communicator& communicator,
                                               const std::filesystem::path& folder, std::uint64_t identity,
                                               Warn warn);
  /// Removes all files of rounds of a folder, unless it is a link to another, and the folder if nothing else
  /// is there.
  static void remove(const std::filesystem::path& folder);

  /// Collective: what an earlier job has kept, with any number of ranks, goes into the hierarchy and `paths`.
  /// Returns its rounds; none, and the hierarchy is as it was, where nothing stands there or anything of it
  /// is damaged, which is logged with what follows from it. Throws AgreedError where the file of rounds is
  /// there and cannot be read.
  [[nodiscard]] std::vector<HierarchyRound> restore(Hierarchy& hierarchy, AuditPaths& paths);

  /// Collective: what the hierarchy has come to takes the place of what stands there. Where that cannot be
  /// written that is logged, and what stands there stays.
  void keep(const Hierarchy& hierarchy, const std::vector<HierarchyRound>& rounds, const AuditPaths& paths);

  /// Collective.
  [[nodiscard]] CheckpointCounts counts() const;

 private:
  [[nodiscard]] std::filesystem::path rounds_path() const;
  [[nodiscard]] std::filesystem::path links_path(std::uint64_t round, std::uint64_t rank,
                                                 std::uint64_t ranks) const;
  [[nodiscard]] std::optional<Bytes> read_rounds() const;
  bool warn_of_all(const std::vector<std::string>& mine, const char* consequence);
  void write_links(std::uint64_t round, const Hierarchy& hierarchy);
  void remove_others(std::uint64_t round) const;

  const Communicator* communicator_ = nullptr;  // none: nothing is kept
  std::filesystem::path folder_;
  std::uint64_t identity_ = 0;
  Warn warn_;
  bool can_do_without_ = false;                        ///< files that cannot be read are as if damaged
  const char* consequence_ = "the rounds begin anew";  ///< of files that are damaged
  CheckpointCounts mine_;
};

}  // namespace fluxel

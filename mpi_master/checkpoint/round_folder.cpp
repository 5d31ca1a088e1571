#include "mpi_master/checkpoint/round_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/input_error_at.hpp"
#include "core/options.hpp"
#include "core/temporary_file.hpp"
#include "hierarchy/kept_rounds.hpp"
#include "hierarchy/link_file.hpp"
#include "mpi_master/checkpoint/folder_names.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/texts.hpp"

namespace fluxel {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRoundsPrefix = "rounds-", kLinksPrefix = "links-", kRoundSuffix = ".fxr";

std::size_t count_rounds(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code ignored;
  for (const std::string& name : names_in(folder, ignored))
    if (name.starts_with(kRoundsPrefix) && name.ends_with(kRoundSuffix)) ++count;
  return count;
}

/// What the work does not come to, if anything.
std::vector<std::string> failure_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return {error.what()};
  }
  return {};
}

/// The whole file. Throws InputError where it cannot be read.
Bytes bytes_of(const fs::path& file) {
  const auto refuse = [&](const std::string& reason) {
    throw input_error_at(file, 0, "cannot be read: " + reason,
                         "make it readable, or begin anew with another --checkpoint");
  };
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(file, failed);
  if (failed) refuse(failed.message());
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(std::generic_category().message(errno));
  Bytes bytes(size);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    refuse("it ends too early");
  return bytes;
}

}  // namespace

RoundFolder::RoundFolder(const Communicator& communicator, const Options& options, std::uint64_t identity,
                         Warn warn)
    : folder_(options.checkpoint), identity_(identity), warn_(std::move(warn)) {
  if (folder_.empty()) return;
  communicator_ = &communicator;
  on_root(communicator, [&] {
    require_writable_folder(folder_);
    const bool stands = fs::exists(rounds_path());
    if (stands && !options.resume)
      throw input_error_at(folder_, 0, "holds rounds of this very solution",
                           "give --resume to go on with them, or another --checkpoint");
    if (const std::size_t foreign = count_rounds(folder_); !stands && foreign > 0)
      warn_(
          fmt::format("{} file{} of rounds in {} {} of another scene, other options or another instruction "
                      "set",
                      foreign, foreign == 1 ? "" : "s", folder_.string(), foreign == 1 ? "is" : "are"));
  });
  // A folder of one host's own would leave the others nowhere to write.
  agree(communicator, [&] {
    if (!fs::is_directory(folder_))
      throw input_error_at(folder_, 0, "is not there on every host",
                           "give --checkpoint a folder that all share");
  });
}

RoundFolder RoundFolder::of_solution(const Communicator& communicator, const fs::path& folder,
                                     std::uint64_t identity, Warn warn) {
  RoundFolder of;
  of.communicator_ = &communicator;
  of.folder_ = folder;
  of.identity_ = identity;
  of.warn_ = std::move(warn);
  of.can_do_without_ = true;
  of.consequence_ = "pictures are gathered by rays";
  return of;
}

void RoundFolder::remove(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(fs::symlink_status(folder, ignored))) return;
  for (const std::string& name : names_in(folder, ignored))
    if ((name.starts_with(kRoundsPrefix) || name.starts_with(kLinksPrefix)) && name.ends_with(kRoundSuffix))
      fs::remove(folder / name, ignored);
  fs::remove(folder, ignored);
}

fs::path RoundFolder::rounds_path() const {
  return folder_ / fmt::format("{}{}{}", kRoundsPrefix, hash_text(identity_), kRoundSuffix);
}

fs::path RoundFolder::links_path(std::uint64_t round, std::uint64_t rank, std::uint64_t ranks) const {
  return folder_ / fmt::format("{}{}-{}-{}-of-{}{}", kLinksPrefix, hash_text(identity_), round, rank, ranks,
                               kRoundSuffix);
}

/// Warns of what any rank says, and of what comes of it. Whether anybody has said anything.
bool RoundFolder::warn_of_all(const std::vector<std::string>& mine, const char* consequence) {
  const std::vector<std::string> all = texts_of_all(*communicator_, mine);
  // All ranks read each header, and may say the same of it.
  if (communicator_->is_root())
    for (const std::string& sentence : std::set(all.begin(), all.end()))
      warn_(fmt::format("{}: {}", sentence, consequence));
  return !all.empty();
}

/// The root's file for all ranks; nothing where there is none. One that is there and cannot be read is not
/// taken for none: the rounds that begin anew would replace it.
std::optional<Bytes> RoundFolder::read_rounds() const {
  std::uint64_t stands = 0;
  Bytes bytes;
  on_root(*communicator_, [&] {
    std::error_code failed;
    if (!fs::exists(rounds_path(), failed) && !failed) return;
    try {
      bytes = bytes_of(rounds_path());
      stands = 1;
    } catch (const InputError&) {
      if (!can_do_without_) throw;
      warn_(fmt::format("{} cannot be read: {}", rounds_path().string(), consequence_));
    }
  });
  communicator_->all_sum(std::span(&stands, 1));  // the others have 0
  if (stands == 0) return std::nullopt;
  communicator_->broadcast(bytes);
  return bytes;
}

std::vector<HierarchyRound> RoundFolder::restore(Hierarchy& hierarchy, AuditPaths& paths) {
  if (communicator_ == nullptr) return {};
  const std::optional<Bytes> bytes = read_rounds();
  if (!bytes) return {};
  RoundsFileResult found = read_rounds_file(*bytes, identity_);
  std::vector<std::string> defects;
  if (!found.kept && communicator_->is_root())
    defects.push_back(fmt::format("{} {}", rounds_path().string(), found.defect));
  if (warn_of_all(defects, consequence_)) return {};

  std::vector<HierarchyRound> rounds = found.kept->rounds;
  const auto rank = static_cast<std::uint64_t>(communicator_->rank());
  const auto ranks = static_cast<std::uint64_t>(communicator_->size());
  std::vector<Link> links;
  RefinementCounts counts;
  for (std::uint64_t file = 0; file < found.kept->ranks && defects.empty(); ++file) {
    const fs::path path = links_path(rounds.size(), file, found.kept->ranks);
    std::ifstream stream(path, std::ios::binary);
    const LinkFileResult result =
        read_link_file(stream, {identity_, rounds.size()}, rounds.back().nodes,
                       [&](std::uint64_t segment) { return (file + segment) % ranks == rank; });
    if (!result.defect.empty()) {
      std::error_code ignored;
      const std::string unread = fs::exists(path, ignored) ? "cannot be opened" : "is missing";
      defects.push_back(fmt::format("{} {}", path.string(), stream.is_open() ? result.defect : unread));
    }
    links.insert(links.end(), result.links.begin(), result.links.end());
    if (file % ranks == rank) counts += result.counts;
  }
  if (warn_of_all(defects, consequence_)) return {};
  std::uint64_t all_links = links.size();
  communicator_->all_sum(std::span(&all_links, 1));
  if (all_links != rounds.back().links) {
    if (communicator_->is_root())
      warn_(fmt::format("the files of links in {} are not of one round: {}", folder_.string(), consequence_));
    return {};
  }
  paths = std::move(found.kept->paths);
  agree(*communicator_, [&] { hierarchy.restore(std::move(*found.kept), std::move(links), counts); });
  return rounds;
}

void RoundFolder::write_links(std::uint64_t round, const Hierarchy& hierarchy) {
  const auto rank = static_cast<std::uint64_t>(communicator_->rank());
  const auto ranks = static_cast<std::uint64_t>(communicator_->size());
  const fs::path path = links_path(round, rank, ranks);
  write_atomically(path, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    write_link_file(stream, {identity_, round}, hierarchy.own_links(), hierarchy.counts());
    mine_.bytes = static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream.tellp()));
    stream.close();
    if (!stream) throw std::runtime_error(std::generic_category().message(errno));
  });
}

void RoundFolder::keep(const Hierarchy& hierarchy, const std::vector<HierarchyRound>& rounds,
                       const AuditPaths& paths) {
  if (communicator_ == nullptr) return;
  constexpr const char* kLost = "the round is not kept, and the run goes on";
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t round = rounds.size();
  bool failed = warn_of_all(failure_of([&] { write_links(round, hierarchy); }), kLost);
  if (!failed)
    failed = warn_of_all(failure_of([&] {
                           if (!communicator_->is_root()) return;
                           const auto ranks = static_cast<std::uint64_t>(communicator_->size());
                           const std::string bytes =
                               rounds_file({ranks,
                                            rounds,
                                            hierarchy.tree().halvings(),
                                            {hierarchy.cut().begin(), hierarchy.cut().end()},
                                            hierarchy.radiosity(),
                                            paths},
                                           identity_);
                           write_bytes_atomically(rounds_path(), bytes);
                           mine_.bytes += bytes.size();
                           remove_others(round);
                         }),
                         kLost);
  std::error_code ignored;
  if (failed) {
    const auto rank = static_cast<std::uint64_t>(communicator_->rank());
    fs::remove(links_path(round, rank, static_cast<std::uint64_t>(communicator_->size())), ignored);
  } else {
    ++mine_.writes;
  }
  mine_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Links of earlier rounds, and what killed jobs have left of theirs.
void RoundFolder::remove_others(std::uint64_t round) const {
  const auto ranks = static_cast<std::uint64_t>(communicator_->size());
  std::set<std::string> own;
  for (std::uint64_t rank = 0; rank < ranks; ++rank)
    own.insert(links_path(round, rank, ranks).filename().string());
  const std::string ours = fmt::format("{}{}-", kLinksPrefix, hash_text(identity_));
  std::error_code ignored;
  for (const std::string& name : names_in(folder_, ignored))
    if (name.starts_with(ours) && name.ends_with(kRoundSuffix) && !own.contains(name))
      fs::remove(folder_ / name, ignored);
  remove_abandoned(folder_, ours);
}

CheckpointCounts RoundFolder::counts() const {
  const std::uint64_t files = mine_.writes == 0 ? 0 : communicator_->is_root() ? 2 : 1;
  std::array<std::uint64_t, 3> sums{files, mine_.bytes, files * mine_.writes};
  communicator_->all_sum(sums);
  double seconds = mine_.seconds;
  communicator_->all_max(std::span(&seconds, 1));
  return {sums[0], sums[1], sums[2], seconds};
}

}  // namespace fluxel

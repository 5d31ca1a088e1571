#include "mpi_master/checkpoint/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/file.hpp"
#include "core/input_error_at.hpp"
#include "core/options.hpp"
#include "mpi_master/checkpoint/strip_folder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/texts.hpp"

namespace fluxel {

namespace fs = std::filesystem;

namespace {

/// More than any run takes; the clock counts to 292 years [s].
constexpr double kLongestPause = 1e9;

std::string foreign_strips(const fs::path& folder, const std::vector<fs::path>& foreign) {
  return fmt::format(
      "{} strip file{} in {}, such as {}, {} of another scene, other elements or another instruction set",
      foreign.size(), foreign.size() == 1 ? "" : "s", folder.string(), foreign.front().filename().string(),
      foreign.size() == 1 ? "is" : "are");
}

}  // namespace

Checkpoint::Checkpoint(const Communicator& communicator, const Options& options, const StripFileKey& key,
                       std::function<void(const std::string&)> warn)
    : communicator_(&communicator),
      key_(key),
      warn_(std::move(warn)),
      folder_(options.checkpoint),
      every_(std::min(options.checkpoint_every, kLongestPause)) {
  std::vector<std::string> files;
  on_root(communicator, [&] {
    const auto take = [&](const fs::path& folder) {
      const FoundStrips found = find_strips(folder, key);
      for (const fs::path& file : found.files) files.push_back(file.string());
      if (found.files.empty() && !found.foreign.empty()) this->warn(foreign_strips(folder, found.foreign));
      return found.files.size();
    };
    if (!folder_.empty()) {
      require_writable_folder(folder_);
      if (take(folder_) > 0 && !options.resume)
        throw input_error_at(folder_, 0, "holds strips of this very matrix",
                             "give --resume to go on with them, or another --checkpoint");
    }
    if (!options.reuse_visibility.empty() && take(options.reuse_visibility) == 0)
      this->warn(fmt::format("{} holds no strips of these elements: all visibility is computed",
                             options.reuse_visibility));
  });
  for (const std::string& file : texts_of_all(communicator, files)) earlier_.emplace_back(file);
  if (folder_.empty()) return;
  file_ = folder_ / strip_file_name(key, communicator.rank(), communicator.size());
  next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(every_);
  // A folder of one host's own would leave the others nowhere to write.
  agree(communicator, [&] {
    if (!fs::is_directory(folder_))
      throw input_error_at(folder_, 0, "is not there on every host",
                           "give --checkpoint a folder that all share");
  });
}

void Checkpoint::warn(const std::string& sentence) {
  if (!warn_ || std::ranges::find(warned_, sentence) != warned_.end()) return;
  warned_.push_back(sentence);
  warn_(sentence);
}

bool Checkpoint::write(const TileStore& store) {
  const auto start = Clock::now();
  if (store.held() > tiles_written_ || writes_ == 0) {
    try {
      bytes_ = write_strips(file_, key_, makers_, store);
      tiles_written_ = store.held();
      ++writes_;
      failure_.clear();
    } catch (const InputError& error) {
      failure_ = error.what();
    }
  }
  const auto end = Clock::now();
  seconds_ += std::chrono::duration<double>(end - start).count();
  // From the end: where writing takes long, computing still goes on.
  next_ = end + std::chrono::duration_cast<Clock::duration>(every_);
  return failure_.empty();
}

std::string Checkpoint::write_all(const TileStore& store, bool replaces) {
  write(store);
  std::vector<std::string> reasons;
  if (!failure_.empty()) reasons.push_back(failure_);
  reasons = texts_of_all(*communicator_, reasons);
  if (!reasons.empty()) return reasons.front();
  if (replaces && communicator_->is_root()) remove_other_strips(folder_, key_, communicator_->size());
  return {};
}

CheckpointCounts Checkpoint::counts() const {
  std::array<std::uint64_t, 3> sums{writes_ > 0 ? 1u : 0u, bytes_, writes_};
  communicator_->all_sum(sums);
  double seconds = seconds_;
  communicator_->all_max(std::span(&seconds, 1));
  return {sums[0], sums[1], sums[2], seconds};
}

}  // namespace fluxel

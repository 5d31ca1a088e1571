#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mpi_master/communication/communicator.hpp"
#include "visibility/strip_file.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

struct Options;

/// What was written, all ranks together.
struct CheckpointCounts {
  std::uint64_t files = 0;   ///< that stand in the folder
  std::uint64_t bytes = 0;   ///< of these
  std::uint64_t writes = 0;  ///< of files, those that a later one has replaced included
  double seconds = 0;        ///< of the rank that spent most on it
};

/// Finished strips on disk: where this job keeps its own, and where it may take those of earlier ones from.
/// Every rank has a file of its own, which it replaces whole.
class Checkpoint {
 public:
  /// A job that keeps nothing.
  Checkpoint() = default;

  /// Collective, by the options checkpoint, resume and reuse_visibility. Throws AgreedError where a folder
  /// cannot be used, or one to be written to has strips of this key and is not to be resumed. `warn` is
  /// called on the root alone.
  Checkpoint(const Communicator& communicator, const Options& options, const StripFileKey& key,
             std::function<void(const std::string&)> warn);

  [[nodiscard]] bool keeps() const { return !file_.empty(); }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const StripFileKey& key() const { return key_; }

  /// Files of earlier jobs, the same on all ranks.
  [[nodiscard]] const std::vector<std::filesystem::path>& earlier() const { return earlier_; }

  /// Who has a part in what is kept, of StripMaker.
  [[nodiscard]] std::uint32_t makers() const { return makers_; }
  void add_makers(std::uint32_t makers) { makers_ |= makers; }

  /// On the root: warns the user, the same sentence once.
  void warn(const std::string& sentence);

  /// Whether the time between two writes has passed.
  [[nodiscard]] bool is_due() const { return keeps() && Clock::now() >= next_; }

  /// Writes what this rank's store has, where that is more than stands there. False where it cannot; then
  /// failure() says why.
  bool write(const TileStore& store);
  [[nodiscard]] const std::string& failure() const { return failure_; }

  /// Collective: all ranks write, and see whether all of them could. Returns why not, or nothing. `replaces`:
  /// all that files of other jobs have of this matrix is in the stores by now, so that these are removed.
  std::string write_all(const TileStore& store, bool replaces);

  /// Collective.
  [[nodiscard]] CheckpointCounts counts() const;

 private:
  using Clock = std::chrono::steady_clock;

  const Communicator* communicator_ = nullptr;
  StripFileKey key_;
  std::function<void(const std::string&)> warn_;
  std::vector<std::string> warned_;
  std::filesystem::path folder_, file_;
  std::vector<std::filesystem::path> earlier_;
  std::chrono::duration<double> every_{};
  Clock::time_point next_;
  std::uint32_t makers_ = 0;
  std::size_t tiles_written_ = 0;
  std::string failure_;
  std::uint64_t bytes_ = 0, writes_ = 0;
  double seconds_ = 0;
};

}  // namespace fluxel

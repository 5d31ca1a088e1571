#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "visibility/strip_file.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

/// Name of the file in which a rank of so many keeps its strips.
[[nodiscard]] std::string strip_file_name(const StripFileKey& key, int rank, int ranks);

/// What a folder of strips holds.
struct FoundStrips {
  std::vector<std::filesystem::path> files;    ///< by name of this key, ascending
  std::vector<std::filesystem::path> foreign;  ///< of other keys
};

/// Throws InputError where the folder is none or cannot be read.
[[nodiscard]] FoundStrips find_strips(const std::filesystem::path& folder, const StripFileKey& key);

/// Removes all files of this key but those that a job of so many ranks writes: they hold nothing more.
/// Half-written ones that a kill has left are removed too.
void remove_other_strips(const std::filesystem::path& folder, const StripFileKey& key, int ranks);

/// Writes the tiles (row, column >= row) of the rows that a store owns, as far as they have been put, whole
/// and atomically; returns the file's size [bytes]. So each tile of the matrix stands in one rank's file.
/// `makers` is of StripMaker. Throws InputError with the system's reason.
std::uintmax_t write_strips(const std::filesystem::path& file, const StripFileKey& key, std::uint32_t makers,
                            const TileStore& store);

}  // namespace fluxel

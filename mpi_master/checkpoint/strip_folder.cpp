#include "mpi_master/checkpoint/strip_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/input_error_at.hpp"
#include "core/temporary_file.hpp"
#include "mpi_master/checkpoint/folder_names.hpp"

namespace fluxel {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kStripPrefix = "strips-", kStripSuffix = ".fxs";

std::string prefix_of(const StripFileKey& key) {
  return fmt::format("{}{}-", kStripPrefix, hash_text(key.identity));
}

std::vector<std::string> all_names_in(const fs::path& folder) {
  std::error_code failed;
  std::vector<std::string> names = names_in(folder, failed);
  if (failed) throw input_error_at(folder, 0, "the folder of strips cannot be read: " + failed.message());
  return names;
}

}  // namespace

std::string strip_file_name(const StripFileKey& key, int rank, int ranks) {
  return fmt::format("{}{}-of-{}{}", prefix_of(key), rank, ranks, kStripSuffix);
}

FoundStrips find_strips(const fs::path& folder, const StripFileKey& key) {
  FoundStrips found;
  for (const std::string& name : all_names_in(folder)) {
    if (!name.starts_with(kStripPrefix) || !name.ends_with(kStripSuffix)) continue;
    (name.starts_with(prefix_of(key)) ? found.files : found.foreign).push_back(folder / name);
  }
  return found;
}

void remove_other_strips(const fs::path& folder, const StripFileKey& key, int ranks) {
  std::set<std::string> own;
  for (int rank = 0; rank < ranks; ++rank) own.insert(strip_file_name(key, rank, ranks));
  for (const std::string& name : all_names_in(folder)) {
    const bool ours = name.starts_with(prefix_of(key)) && name.ends_with(kStripSuffix);
    std::error_code ignored;  // what cannot be removed is read once more at most
    if (ours && !own.contains(name)) fs::remove(folder / name, ignored);
  }
  remove_abandoned(folder, prefix_of(key));
}

std::uintmax_t write_strips(const fs::path& file, const StripFileKey& key, std::uint32_t makers,
                            const TileStore& store) {
  std::uintmax_t bytes = 0;
  write_atomically(file, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    StripFileWriter writer(stream, key, makers);
    const TileTriangle triangle(store.tiles());
    const TileRows& rows = store.owned();
    for (std::size_t row = rows.first; row < rows.last && stream; ++row)
      for (std::size_t column = row; column < store.tiles(); ++column)
        if (store.has(row, column)) writer.add(triangle.number(row, column), store.view(row, column));
    writer.finish();
    bytes = static_cast<std::uintmax_t>(std::max<std::streamoff>(0, stream.tellp()));
    stream.close();
    if (!stream) throw std::runtime_error(std::generic_category().message(errno));
  });
  return bytes;
}

}  // namespace fluxel

#pragma once

#include <filesystem>
#include <functional>

namespace fluxel {

/// Writes a file under a temporary name beside it and renames it when all bytes are on disk, so that no
/// half-written file ever stands under its final name. `write` gets the temporary path and throws or returns;
/// the result is flushed and checked. Throws InputError with the system's reason (disk full, no permission);
/// the temporary file is removed.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

/// Makes the folder and shows, by writing and removing a small file, that it can be written to.
/// Throws InputError where not.
void require_writable_folder(const std::filesystem::path& folder);

}  // namespace fluxel

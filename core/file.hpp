#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace fluxel {

/// Writes a file under a temporary name beside it and renames it when all bytes are on disk, so that no
/// half-written file ever stands under its final name. `write` gets the temporary path and throws or returns;
/// the result is flushed and checked. Throws InputError with the system's reason (disk full, no permission);
/// out of memory and logic errors of `write` pass through. The temporary file is removed in every case.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

/// The same for bytes that are all there.
void write_bytes_atomically(const std::filesystem::path& file, std::string_view bytes);

/// Makes the folder and shows, by writing and removing a small file, that it can be written to.
/// Throws InputError where not.
void require_writable_folder(const std::filesystem::path& folder);

}  // namespace fluxel

#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

namespace fluxel {

/// Writes a file under a temporary name beside it (core/temporary_file) and renames it when all bytes are on
/// disk, so that no half-written file ever stands under its final name. `write` gets the path of an empty
/// file and throws or returns; the result is flushed and checked, and so is the folder, so that what comes
/// later cannot reach the disk before it. Throws InputError with the system's reason (disk full, no
/// permission); out of memory and logic errors of `write` pass through. The temporary file is removed in
/// every case.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

/// The same for what is made part by part: `write` gets a function that appends.
void write_parts_atomically(
    const std::filesystem::path& file,
    const std::function<void(const std::function<void(std::string_view)>& append)>& write);

/// The same for bytes that are all there.
void write_bytes_atomically(const std::filesystem::path& file, std::string_view bytes);

/// Makes the folder and shows, by writing and removing a small file, that it can be written to.
/// Throws InputError where not.
void require_writable_folder(const std::filesystem::path& folder);

/// Throws InputError where an output, which need not be there, is one of the inputs, by whatever path or
/// link.
void require_inputs_kept(std::span<const std::filesystem::path> inputs,
                         std::span<const std::filesystem::path> outputs);

}  // namespace fluxel

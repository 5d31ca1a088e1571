#include "core/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "core/input_error_at.hpp"
#include "core/temporary_file.hpp"

namespace fluxel {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void throw_cannot_write(const fs::path& file, const std::string& reason) {
  throw input_error_at(file, 0, "cannot be written: " + reason,
                       "check the disk's free space and permissions");
}

std::string system_reason(int code) { return std::generic_category().message(code); }

/// A full disk may show only when the kernel is asked to bring the bytes to it.
void flush_to_disk(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw_cannot_write(file, system_reason(errno));
  const int failed = fsync(descriptor) != 0 ? errno : 0;
  close(descriptor);
  // Some special files cannot be synchronised; they have nothing to lose.
  if (failed != 0 && failed != EINVAL) throw_cannot_write(file, system_reason(failed));
}

/// So that the file stands under its name after a crash too, before anything is done that relies on it.
void flush_folder_of(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // it may be written to and not read
  const int failed = fsync(descriptor) != 0 ? errno : 0;
  close(descriptor);
  if (failed == EIO) throw_cannot_write(file, system_reason(failed));
}

using Append = std::function<void(std::string_view)>;

void write_parts(const fs::path& file, const std::function<void(const Append&)>& write) {
  std::ofstream stream(file, std::ios::binary);
  const auto require_written = [&stream] {
    if (!stream) throw std::system_error(errno, std::generic_category());
  };
  write([&](std::string_view bytes) {
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    require_written();
  });
  stream.close();
  require_written();
}

void write_bytes(const fs::path& file, std::string_view bytes) {
  write_parts(file, [bytes](const Append& append) { append(bytes); });
}

void remove_abandoned_of(const fs::path& file) {
  remove_abandoned(file.has_parent_path() ? file.parent_path() : fs::path("."), file.filename().string());
}

}  // namespace

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  try {
    // Before, since some file systems cannot tell two locks of one process apart.
    remove_abandoned_of(file);
    TemporaryFile temporary(file);
    write(temporary.path());
    flush_to_disk(temporary.path());
    temporary.rename();
    flush_folder_of(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::system_error& reason) {
    throw_cannot_write(file, reason.code().message());
  } catch (const std::runtime_error& reason) {
    throw_cannot_write(file, reason.what());
  }
}

void write_parts_atomically(const fs::path& file, const std::function<void(const Append&)>& write) {
  write_atomically(file, [&](const fs::path& temporary) { write_parts(temporary, write); });
}

void write_bytes_atomically(const fs::path& file, std::string_view bytes) {
  write_atomically(file, [&](const fs::path& temporary) { write_bytes(temporary, bytes); });
}

void require_writable_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw input_error_at(folder, 0, "the output folder cannot be made: " + failed.message());
  const fs::path probe = folder / ".fluxel-write-test";
  try {
    remove_abandoned_of(probe);
    const TemporaryFile temporary(probe);
    write_bytes(temporary.path(), "fluxel\n");
    flush_to_disk(temporary.path());
  } catch (const std::system_error& reason) {
    throw_cannot_write(folder, reason.code().message());
  }
}

void require_inputs_kept(std::span<const fs::path> inputs, std::span<const fs::path> outputs) {
  for (const fs::path& output : outputs)
    for (const fs::path& input : inputs) {
      std::error_code not_there;
      if (fs::equivalent(output, input, not_there) && !not_there)
        throw input_error_at(output, 0,
                             fmt::format("would be replaced, and it is {}, which is read", input.string()),
                             "choose another --out");
    }
}

}  // namespace fluxel

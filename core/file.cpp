#include "core/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "core/error.hpp"

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

}  // namespace

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = file.string() + ".part";
  std::error_code ignored;
  try {
    write(temporary);
    flush_to_disk(temporary);
    std::error_code failed;
    fs::rename(temporary, file, failed);
    if (failed) throw_cannot_write(file, failed.message());
  } catch (const InputError&) {
    fs::remove(temporary, ignored);
    throw;
  } catch (const std::runtime_error& reason) {
    fs::remove(temporary, ignored);
    throw_cannot_write(file, reason.what());
  } catch (...) {
    fs::remove(temporary, ignored);
    throw;
  }
}

void write_bytes_atomically(const fs::path& file, std::string_view bytes) {
  write_atomically(file, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throw std::runtime_error(system_reason(errno));
  });
}

void require_writable_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw input_error_at(folder, 0, "the output folder cannot be made: " + failed.message());
  write_bytes_atomically(folder / ".fluxel-write-test", "fluxel\n");
  fs::remove(folder / ".fluxel-write-test", failed);
}

}  // namespace fluxel

#include "mpi_master/communication/shared_pages.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

namespace fluxel {

namespace {

/// Bytes from which on a file is made for them; those below about 4 MiB mostly lie in a heap, of each rank
/// elsewhere. Bytes of a message.
constexpr std::size_t kWorthwhile = std::size_t{1} << 20, kMessage = std::size_t{1} << 22;

class FileDescriptor {
 public:
  explicit FileDescriptor(int number) : number_(number) {}
  ~FileDescriptor() {
    if (number_ >= 0) close(number_);
  }
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&&) = delete;

  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

/// Pages that lie within some bytes as a whole.
struct WholePages {
  std::byte* first = nullptr;
  std::size_t size = 0;     ///< [bytes]
  std::size_t skipped = 0;  ///< bytes before the first one

  explicit WholePages(std::span<std::byte> bytes) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const auto start = reinterpret_cast<std::uintptr_t>(bytes.data());
    skipped = (page - start % page) % page;
    if (bytes.size() < skipped + page) return;
    first = bytes.data() + skipped;
    size = (bytes.size() - skipped) / page * page;
  }
};

bool write_all(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// What others on the host find the leader's file by.
struct FileName {
  std::uint64_t process = 0, number = 0;  ///< of the leader and of its descriptor; 0: there is none
  std::uint64_t device = 0, inode = 0;    ///< of the file: in a container a process may have another number
};

/// A file in memory with these pages. Its blocks are reserved before anything is written: memory that turns
/// out to be missing later would end the program.
FileDescriptor make_file(const WholePages& pages) {
  FileDescriptor file(memfd_create("fluxel", MFD_CLOEXEC));
  if (file.is_open() && posix_fallocate(file.number(), 0, static_cast<off_t>(pages.size)) == 0 &&
      write_all(file.number(), {pages.first, pages.size}))
    return file;
  return FileDescriptor(-1);
}

FileName name_of(const FileDescriptor& file) {
  struct stat about {};
  if (!file.is_open() || fstat(file.number(), &about) != 0) return {};
  return {static_cast<std::uint64_t>(getpid()), static_cast<std::uint64_t>(file.number()), about.st_dev,
          about.st_ino};
}

/// Not open where this rank may not, or finds another file.
FileDescriptor open_file(const FileName& name) {
  FileDescriptor file(open(fmt::format("/proc/{}/fd/{}", name.process, name.number).c_str(),
                           O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat about {};
  if (file.is_open() && fstat(file.number(), &about) == 0 && about.st_dev == name.device &&
      about.st_ino == name.inode)
    return file;
  return FileDescriptor(-1);
}

/// The file's pages instead of those that were there.
bool map(const FileDescriptor& file, const WholePages& pages) {
  if (!file.is_open()) return false;
  if (mmap(pages.first, pages.size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_FIXED, file.number(), 0) ==
      MAP_FAILED)
    throw std::system_error(errno, std::generic_category(), "pages of memory cannot be shared");
  return true;
}

/// The leader's, by messages.
void copy(const Communicator& host, std::span<std::byte> bytes) {
  Bytes message;
  for (std::size_t first = 0; first < bytes.size(); first += kMessage) {
    const auto part = bytes.subspan(first, std::min(kMessage, bytes.size() - first));
    message.assign(part.begin(), part.end());
    host.broadcast(message);
    if (!host.is_root()) std::ranges::copy(message, part.begin());
  }
}

}  // namespace

std::size_t share_pages(const Communicator& host, std::span<std::byte> bytes) {
  if (host.size() == 1) return 0;
  const WholePages pages(bytes);
  std::array<std::uint64_t, 2> extremes{pages.skipped, ~std::uint64_t{pages.skipped}};
  host.all_min(extremes);
  if (extremes[0] != ~extremes[1] || pages.size < kWorthwhile) {
    copy(host, bytes);
    return 0;
  }
  const FileDescriptor own = host.is_root() ? make_file(pages) : FileDescriptor(-1);
  FileName name = name_of(own);
  copy(host, std::as_writable_bytes(std::span(&name, 1)));
  std::uint64_t mapped = 0;
  if (name.process != 0) mapped = (host.is_root() ? map(own, pages) : map(open_file(name), pages)) ? 1 : 0;
  // Before the leader closes the file.
  host.all_sum(std::span(&mapped, 1));
  if (mapped < static_cast<std::uint64_t>(host.size())) {
    copy(host, bytes);
    return 0;
  }
  copy(host, bytes.first(pages.skipped));
  copy(host, bytes.subspan(pages.skipped + pages.size));
  return pages.size;
}

}  // namespace fluxel

#include "mpi_master/communication/shared_pages.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <random>
#include <string>
#include <system_error>

namespace fluxel {

namespace {

/// Bytes from which on a file is made for them; of a message.
constexpr std::size_t kWorthwhile = std::size_t{1} << 20, kMessage = std::size_t{1} << 22;

class FileDescriptor {
 public:
  explicit FileDescriptor(int number) : number_(number) {}
  ~FileDescriptor() {
    if (number_ >= 0) close(number_);
  }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

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

/// A file of shared memory with these pages. Its blocks are reserved before anything is written: memory that
/// turns out to be missing later would end the program.
bool make_file(const std::string& name, const WholePages& pages) {
  const FileDescriptor file(shm_open(name.c_str(), O_CREAT | O_EXCL | O_RDWR, S_IRUSR | S_IWUSR));
  if (!file.is_open()) return false;
  if (posix_fallocate(file.number(), 0, static_cast<off_t>(pages.size)) == 0 &&
      write_all(file.number(), {pages.first, pages.size}))
    return true;
  shm_unlink(name.c_str());
  return false;
}

/// These pages instead of those that were there. False where the rank cannot open the file.
bool map(const std::string& name, const WholePages& pages) {
  const FileDescriptor file(shm_open(name.c_str(), O_RDONLY, 0));
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

/// Random: ranks of other jobs have the same /dev/shm.
std::string new_name() {
  std::random_device random;
  return fmt::format("/fluxel-{:08x}{:08x}", random(), random());
}

}  // namespace

std::size_t share_pages(const Communicator& host, std::span<std::byte> bytes) {
  if (host.size() == 1) return 0;
  const WholePages pages(bytes);
  std::string name;
  if (host.is_root() && pages.size >= kWorthwhile) {
    name = new_name();
    if (!make_file(name, pages)) name.clear();
  }
  const auto letters = std::as_bytes(std::span(name));
  Bytes message(letters.begin(), letters.end());
  host.broadcast(message);
  name.assign(reinterpret_cast<const char*>(message.data()), message.size());
  std::array<std::uint64_t, 2> extremes{pages.skipped, ~std::uint64_t{pages.skipped}};
  host.all_min(extremes);
  const bool lie_alike = extremes[0] == ~extremes[1];
  std::uint64_t mapped = !name.empty() && lie_alike && map(name, pages) ? 1 : 0;
  host.all_sum(std::span(&mapped, 1));
  // All have opened the file.
  if (host.is_root() && !name.empty()) shm_unlink(name.c_str());
  if (mapped < static_cast<std::uint64_t>(host.size())) {
    copy(host, bytes);
    return 0;
  }
  copy(host, bytes.first(pages.skipped));
  copy(host, bytes.subspan(pages.skipped + pages.size));
  return pages.size;
}

}  // namespace fluxel

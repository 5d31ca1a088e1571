#include "core/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <random>
#include <string_view>
#include <system_error>

namespace fluxel {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kMark = ".part-";
constexpr std::size_t kDigits = 16;

fs::path random_name(const fs::path& file) {
  std::random_device random;
  return fs::path(file.string() + fmt::format("{}{:08x}{:08x}", kMark, random(), random()));
}

bool is_temporary_name(std::string_view name) {
  if (name.size() < kMark.size() + kDigits) return false;
  const std::string_view ending = name.substr(name.size() - kDigits - kMark.size());
  return ending.starts_with(kMark) &&
         ending.substr(kMark.size()).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Whether somebody else has removed the file, taking it for abandoned before it was locked.
bool is_removed(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && status.st_nlink == 0;
}

/// Where nobody has locked it or, on a file system without locks, has written to it for a day. The lock is
/// held until the file is gone, so that who is about to lock it notices.
void remove_if_abandoned(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  bool abandoned = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  if (!abandoned && errno != EWOULDBLOCK && errno != EINTR) {
    std::error_code failed;
    const auto written = fs::last_write_time(file, failed);
    abandoned = !failed && fs::file_time_type::clock::now() - written > std::chrono::hours(24);
  }
  std::error_code ignored;
  if (abandoned) fs::remove(file, ignored);
  close(descriptor);
}

}  // namespace

TemporaryFile::TemporaryFile(const fs::path& file) : file_(file) {
  while (descriptor_ < 0) {
    path_ = random_name(file);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == EEXIST) continue;
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category());
    flock(descriptor_, LOCK_EX);  // where there are no locks its age has to do
    if (!is_removed(descriptor_)) break;
    close(descriptor_);
    descriptor_ = -1;
  }
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove(path_, ignored);
  close(descriptor_);
}

void TemporaryFile::rename() {
  fs::rename(path_, file_);
  path_.clear();
}

void remove_abandoned(const fs::path& folder, const std::string& prefix) {
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with(prefix) && is_temporary_name(name)) remove_if_abandoned(at->path());
  }
}

}  // namespace fluxel

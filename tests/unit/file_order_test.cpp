// What has to be on the disk before what. The program's own fsync takes the place of the system's here.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/file.hpp"

namespace {

namespace fs = std::filesystem;

struct Flush {
  fs::path what;
  bool file_stood;  // under its final name
};

fs::path watched;  // the final name; empty: nobody looks
std::vector<Flush> flushes;

}  // namespace

extern "C" int fsync(int descriptor) {
  if (!watched.empty())
    flushes.push_back({fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor)), fs::exists(watched)});
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

namespace fluxel {
namespace {

TEST(FileOrder, TheFileIsFlushedBeforeItsNameAndTheFolderAfterIt) {
  const fs::path folder = fs::canonical(testing::TempDir()) / "fluxel_file_order";
  fs::remove_all(folder);
  fs::create_directories(folder);
  flushes.clear();
  watched = folder / "result";
  write_bytes_atomically(watched, "new");
  watched.clear();
  ASSERT_EQ(flushes.size(), 2u);
  EXPECT_TRUE(flushes[0].what.filename().string().starts_with("result.part-"));
  EXPECT_FALSE(flushes[0].file_stood);
  EXPECT_EQ(flushes[1].what, folder);
  EXPECT_TRUE(flushes[1].file_stood);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace fluxel

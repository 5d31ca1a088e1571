#include "core/file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "core/error.hpp"

namespace fluxel {
namespace {

namespace fs = std::filesystem;

class File : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) /
             ("fluxel_file_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    file = folder / "result.txt";
  }
  void TearDown() override { fs::remove_all(folder); }

  [[nodiscard]] std::string content() const {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path folder, file;
};

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream stream(path);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(std::generic_category().message(errno));
}

/// What the InputError that `action` throws says.
template <class Action>
std::string input_error_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return {};
}

TEST_F(File, StandsUnderItsNameOnlyWhenWritten) {
  write_atomically(file, [&](const fs::path& temporary) {
    EXPECT_NE(temporary, file);
    write_text(temporary, "new");
    EXPECT_FALSE(fs::exists(file));
  });
  EXPECT_EQ(content(), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(File, ReplacesAnOlderOne) {
  write_text(file, "an older, longer text");
  write_atomically(file, [](const fs::path& temporary) { write_text(temporary, "new"); });
  EXPECT_EQ(content(), "new");
}

TEST_F(File, FailureKeepsTheOlderOneAndLeavesNothing) {
  write_text(file, "older");
  const std::string message = input_error_of([&] {
    write_atomically(file, [](const fs::path& temporary) {
      write_text(temporary, "half");
      throw std::runtime_error("broken pen");
    });
  });
  EXPECT_NE(message.find("broken pen"), std::string::npos) << message;
  EXPECT_NE(message.find(file.string()), std::string::npos) << message;
  EXPECT_EQ(content(), "older");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(File, InputErrorPassesAsItIs) {
  const std::string message = input_error_of([&] {
    write_atomically(file, [](const fs::path& temporary) {
      write_text(temporary, "half");
      throw InputError("as it is");
    });
  });
  EXPECT_EQ(message, "as it is");
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(File, FullDiskIsNamedAndLeavesNothing) {
  const std::string message = input_error_of([&] {
    write_atomically(file, [](const fs::path& temporary) {
      fs::remove(temporary);
      fs::create_symlink("/dev/full", temporary);
      write_text(temporary, "text");
    });
  });
  EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(File, AMissingFolderIsAnInputError) {
  EXPECT_THROW(write_atomically(folder / "none" / "file",
                                [](const fs::path& temporary) { write_text(temporary, "text"); }),
               InputError);
}

TEST_F(File, AFolderUnderTheFinalNameIsAnInputErrorAndStays) {
  fs::create_directory(file);
  EXPECT_THROW(write_atomically(file, [](const fs::path& temporary) { write_text(temporary, "text"); }),
               InputError);
  EXPECT_TRUE(fs::is_directory(file));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(File, FolderIsMadeWithItsParentsAndLeftEmpty) {
  const fs::path deep = folder / "a" / "b";
  require_writable_folder(deep);
  EXPECT_TRUE(fs::is_empty(deep));
  require_writable_folder(deep);  // one that is there already
}

TEST_F(File, AFileInTheWayOfAFolder) {
  write_text(file, "in the way");
  EXPECT_THROW(require_writable_folder(file), InputError);
  EXPECT_THROW(require_writable_folder(file / "below"), InputError);
  EXPECT_EQ(content(), "in the way");
}

TEST_F(File, AFolderThatCannotBeMadeOrWrittenTo) {
  EXPECT_THROW(require_writable_folder("/proc/fluxel"), InputError);
  EXPECT_THROW(require_writable_folder("/proc"), InputError);
  EXPECT_THROW(require_writable_folder(""), InputError);
}

TEST_F(File, TwoWritersOfOneFileDoNotMeet) {
  write_atomically(file, [&](const fs::path& temporary) {
    write_text(temporary, "first");
    write_bytes_atomically(file, "second");
    EXPECT_EQ(content(), "second");
  });
  EXPECT_EQ(content(), "first");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(File, TwoThatTryAFolderDoNotMeet) {
  std::atomic<int> failures = 0;
  std::vector<std::thread> jobs;
  for (int job = 0; job < 4; ++job)
    jobs.emplace_back([&] {
      for (int k = 0; k < 50; ++k) {
        try {
          require_writable_folder(folder);
        } catch (const InputError&) {
          ++failures;
        }
      }
    });
  for (std::thread& job : jobs) job.join();
  EXPECT_EQ(failures, 0);
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(File, LinksUnderFixedNamesAreNotFollowed) {
  const fs::path victim = folder / "victim";
  write_text(victim, "precious");
  for (const char* name : {"result.txt.part", ".fluxel-write-test", ".fluxel-write-test.part"})
    fs::create_symlink(victim, folder / name);
  write_bytes_atomically(file, "new");
  require_writable_folder(folder);
  std::ifstream stream(victim);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "precious");
  EXPECT_TRUE(fs::is_symlink(folder / ".fluxel-write-test"));
}

TEST_F(File, WhatKilledWritersHaveLeftGoes) {
  const fs::path left = folder / "result.txt.part-0123456789abcdef",
                 live = folder / "result.txt.part-fedcba9876543210",
                 of_another = folder / "other.txt.part-0123456789abcdef",
                 notes = folder / "result.txt.part-of-my-notes.";
  for (const fs::path& path : {left, live, of_another, notes}) write_text(path, "half");
  const int descriptor = open(live.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  write_bytes_atomically(file, "new");
  EXPECT_FALSE(fs::exists(left));
  for (const fs::path& path : {live, of_another, notes}) EXPECT_TRUE(fs::exists(path)) << path;
  close(descriptor);
  write_bytes_atomically(file, "new");
  EXPECT_FALSE(fs::exists(live));
}

TEST_F(File, AnInputUnderAnyNameIsNoOutput) {
  write_text(file, "scene");
  fs::create_directories(folder / "deep");
  fs::create_symlink(file, folder / "link");
  fs::create_hard_link(file, folder / "hard");
  const std::vector<fs::path> inputs{folder / "none", file};
  for (const fs::path& output :
       {file, folder / "deep" / ".." / "result.txt", fs::relative(file), folder / "link", folder / "hard"}) {
    const std::string message = input_error_of([&] {
      require_inputs_kept(inputs, std::array{folder / "a", output});
    });
    EXPECT_NE(message.find(output.string()), std::string::npos) << message;
    EXPECT_NE(message.find(file.string()), std::string::npos) << message;
  }
  EXPECT_NO_THROW(require_inputs_kept(inputs, std::array{folder / "none", folder / "deep"}));
}

}  // namespace
}  // namespace fluxel

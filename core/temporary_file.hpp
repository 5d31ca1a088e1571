#pragma once

#include <filesystem>
#include <string>

namespace fluxel {

/// A new, empty file beside the one that it is to become, under a random name that no other file or link has:
/// FILE.part- and 16 hexadecimal digits. Programs that write the same file at once do not meet in it. It is
/// locked (flock) while this lives; what killed programs have left is not, and is removed by whoever writes
/// FILE next (remove_abandoned).
class TemporaryFile {
 public:
  /// Throws std::system_error where it cannot be made.
  explicit TemporaryFile(const std::filesystem::path& file);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  /// Removes it, unless it has been renamed.
  ~TemporaryFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// It takes the place of the file. Throws std::system_error.
  void rename();

 private:
  std::filesystem::path file_, path_;
  int descriptor_ = -1;  // holds the lock
};

/// Removes the temporary files of programs that are gone, of all files in the folder whose names begin so.
void remove_abandoned(const std::filesystem::path& folder, const std::string& prefix);

}  // namespace fluxel

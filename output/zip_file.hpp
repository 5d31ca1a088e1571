#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace fluxel {

/// A ZIP archive (PKWARE APPNOTE 6.3.10) of files that are stored as they are, made part by part: of 4 GiB
/// and more too, as each has the fields of ZIP64. Times are the format's first, so that equal contents are
/// equal bytes. Throws std::system_error where it cannot be written.
class ZipFile {
 public:
  explicit ZipFile(const std::filesystem::path& file);

  void begin(std::string_view name);
  void append(std::string_view bytes);  ///< to the file that was begun last
  void finish();                        ///< the archive

 private:
  struct Entry {
    std::string name;
    std::uint64_t place = 0, size = 0;
    std::uint32_t checksum = 0;
  };

  void end_entry();
  void write(std::string_view bytes);
  [[nodiscard]] static std::string local_header(const Entry& entry);

  std::ofstream stream_;
  std::uint64_t written_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace fluxel

#include "output/zip_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>

namespace fluxel {

namespace {

constexpr std::uint32_t kUnknown32 = 0xFFFFFFFFu;  // ZIP64: it stands in the extra field
constexpr std::uint16_t kVersion = 45;             // the first that knows ZIP64
constexpr std::uint16_t kFirstDay = 0x21;          // 1 January 1980

template <class Number>
void put(std::string& bytes, Number number) {
  for (std::size_t k = 0; k < sizeof number; ++k)
    bytes += static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * k) & 0xFFu);
}

/// From `version needed` to `length of the extra field`, which both headers of a file have.
void put_description(std::string& bytes, std::uint32_t checksum, std::size_t name, std::uint16_t extra) {
  put(bytes, kVersion);
  put(bytes, std::uint16_t{0});  // flags
  put(bytes, std::uint16_t{0});  // stored
  put(bytes, std::uint16_t{0});  // time
  put(bytes, kFirstDay);
  put(bytes, checksum);
  put(bytes, kUnknown32);  // both sizes
  put(bytes, kUnknown32);
  put(bytes, static_cast<std::uint16_t>(name));
  put(bytes, extra);
}

}  // namespace

ZipFile::ZipFile(const std::filesystem::path& file) : stream_(file, std::ios::binary) { write({}); }

void ZipFile::begin(std::string_view name) {
  end_entry();
  entries_.push_back({std::string(name), written_, 0, 0});
  write(local_header(entries_.back()));
}

void ZipFile::append(std::string_view bytes) {
  Entry& entry = entries_.back();
  // zlib counts in 32 bits.
  for (std::size_t first = 0; first < bytes.size();) {
    const std::size_t some =
        std::min<std::size_t>(bytes.size() - first, std::numeric_limits<std::int32_t>::max());
    entry.checksum = static_cast<std::uint32_t>(
        crc32(entry.checksum, reinterpret_cast<const Bytef*>(bytes.data() + first), static_cast<uInt>(some)));
    first += some;
  }
  entry.size += bytes.size();
  write(bytes);
}

void ZipFile::finish() {
  end_entry();
  const std::uint64_t directory = written_;
  for (const Entry& entry : entries_) {
    std::string bytes("PK\x01\x02", 4);
    put(bytes, kVersion);
    put_description(bytes, entry.checksum, entry.name.size(), 28);
    put(bytes, std::uint16_t{0});  // comment
    put(bytes, std::uint16_t{0});  // disk
    put(bytes, std::uint16_t{0});  // attributes, inner and outer
    put(bytes, std::uint32_t{0});
    put(bytes, kUnknown32);  // place
    bytes += entry.name;
    put(bytes, std::uint16_t{1});
    put(bytes, std::uint16_t{24});
    put(bytes, entry.size);
    put(bytes, entry.size);
    put(bytes, entry.place);
    write(bytes);
  }
  const std::uint64_t end = written_;
  std::string bytes("PK\x06\x06", 4);
  put(bytes, std::uint64_t{44});  // bytes that follow
  put(bytes, kVersion);
  put(bytes, kVersion);
  put(bytes, std::uint64_t{0});  // disks
  put(bytes, std::uint64_t{entries_.size()});
  put(bytes, std::uint64_t{entries_.size()});
  put(bytes, end - directory);
  put(bytes, directory);
  bytes += std::string("PK\x06\x07", 4);
  put(bytes, std::uint32_t{0});
  put(bytes, end);
  put(bytes, std::uint32_t{1});
  bytes += std::string("PK\x05\x06", 4);
  put(bytes, std::uint32_t{0});  // disks
  put(bytes, static_cast<std::uint16_t>(entries_.size()));
  put(bytes, static_cast<std::uint16_t>(entries_.size()));
  put(bytes, kUnknown32);  // size and place of the directory
  put(bytes, kUnknown32);
  put(bytes, std::uint16_t{0});  // comment
  write(bytes);
  stream_.close();
  write({});
}

/// Its size and checksum are known now: they go back into its header.
void ZipFile::end_entry() {
  if (entries_.empty()) return;
  const Entry& entry = entries_.back();
  const std::string header = local_header(entry);
  stream_.seekp(static_cast<std::streamoff>(entry.place));
  stream_.write(header.data(), static_cast<std::streamsize>(header.size()));
  stream_.seekp(static_cast<std::streamoff>(written_));
}

void ZipFile::write(std::string_view bytes) {
  if (!bytes.empty()) stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) throw std::system_error(errno, std::generic_category());
  written_ += bytes.size();
}

std::string ZipFile::local_header(const Entry& entry) {
  std::string bytes("PK\x03\x04", 4);
  put_description(bytes, entry.checksum, entry.name.size(), 20);
  bytes += entry.name;
  put(bytes, std::uint16_t{1});
  put(bytes, std::uint16_t{16});
  put(bytes, entry.size);
  put(bytes, entry.size);
  return bytes;
}

}  // namespace fluxel

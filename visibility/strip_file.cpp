#include "visibility/strip_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <istream>
#include <optional>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string_view>

#include "core/hash.hpp"
#include "visibility/tile_code.hpp"

namespace fluxel {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little endian");

constexpr std::string_view kFileMagic = "FLXSTRIP";
constexpr std::string_view kSegmentMagic = "FLXRANGE";
constexpr std::uint32_t kVersion = 2;

constexpr std::uint32_t kAllMakers = kMadeByProcessor | kMadeByGpu;

/// Of a segment's payload [bytes]: so much may be lost by one damaged byte, and has to be in memory.
constexpr std::size_t kMaxPayload = std::size_t{1} << 20;

struct FileHeader {
  std::array<char, 8> magic;
  std::uint32_t version, tile_size;
  std::uint64_t identity, elements;
  std::uint64_t makers;
  std::uint64_t check;  // of what stands before
};
static_assert(sizeof(FileHeader) == 48);

/// The last segment of a file has none, and the number of the file's tiles as both ends of its range.
struct SegmentHeader {
  std::array<char, 8> magic;
  TileRange range;
  std::uint64_t payload_bytes, payload_check;
  // Of what stands before, begun with the file's identity: so a segment is known for what it is where the
  // file's header is damaged.
  std::uint64_t check;
};
static_assert(sizeof(SegmentHeader) == 48);

template <class Header>
std::uint64_t check_of(const Header& header, std::uint64_t seed = 0) {
  return hash_bytes(std::as_bytes(std::span(&header, 1)).first(offsetof(Header, check)), seed);
}

std::array<char, 8> to_array(std::string_view magic) {
  std::array<char, 8> characters;
  magic.copy(characters.data(), characters.size());
  return characters;
}

std::string_view view(const std::array<char, 8>& magic) { return {magic.data(), magic.size()}; }

template <class T>
void write(std::ostream& stream, const T& object) {
  stream.write(reinterpret_cast<const char*>(&object), sizeof object);
}

/// One reading of one file.
class StripFileReader {
 public:
  StripFileReader(std::istream& stream, const StripFileKey& key,
                  const std::function<void(std::uint64_t, const TileView&)>& take)
      : stream_(stream), key_(key), take_(take), all_(TileTriangle(tile_count(key.elements)).size()) {
    stream.seekg(0, std::ios::end);
    const std::streamoff end = stream.tellg();
    if (stream && end > 0) bytes_ = static_cast<std::uint64_t>(end);
  }

  StripFileResult read() {
    if (auto refusal = refuse_header()) return {0, 0, *refusal};
    std::uint64_t at = sizeof(FileHeader);
    while (at < bytes_) at = read_segment(at);
    if (damaged_header_ || lost_ > 0 || !ended_) result_.defect = "is damaged or cut off";
    return std::move(result_);
  }

 private:
  /// Why nothing of the file can be taken. A header that only is damaged loses nothing else.
  std::optional<std::string> refuse_header() {
    const auto header = load<FileHeader>(0);
    if (!header) return "is too short to be a file of strips";
    damaged_header_ = header->check != check_of(*header);
    if (damaged_header_) {
      result_.makers = kAllMakers;
      if (view(header->magic) == kFileMagic || find_segment(sizeof *header) < bytes_) return std::nullopt;
      return "is no file of strips";
    }
    if (view(header->magic) != kFileMagic) return "is no file of strips";
    if (header->version != kVersion || header->tile_size != kTileSize)
      return fmt::format("is of another version of the format ({} where {} is needed)", header->version,
                         kVersion);
    if (StripFileKey{header->identity, header->elements} != key_)
      return "is of another scene, other elements or another instruction set";
    result_.makers = static_cast<std::uint32_t>(header->makers & kAllMakers);
    return std::nullopt;
  }

  /// Takes the segment that begins there, if one does; returns where to go on.
  std::uint64_t read_segment(std::uint64_t at) {
    const auto header = load<SegmentHeader>(at);
    if (!header || !is_valid(*header) || header->payload_bytes > bytes_ - at - sizeof *header) {
      ++lost_;
      return find_segment(at + 1);
    }
    const std::uint64_t first = at + sizeof *header;
    ended_ = header->range.size() == 0 && first == bytes_;
    payload_.resize(header->payload_bytes);
    if (!load(first, std::as_writable_bytes(std::span(payload_))) ||
        hash_bytes(payload_) != header->payload_check || !take_all(header->range))
      ++lost_;
    return first + header->payload_bytes;
  }

  [[nodiscard]] bool is_valid(const SegmentHeader& header) const {
    return view(header.magic) == kSegmentMagic && header.check == check_of(header, key_.identity) &&
           header.range.first <= header.range.last && header.range.last <= all_ &&
           header.payload_bytes <= kMaxPayload;
  }

  /// False, and nothing is taken, where the payload is not the tiles of the range.
  bool take_all(const TileRange& range) {
    std::uint64_t count = 0;
    try {
      for (std::span<const std::byte> rest(payload_); !rest.empty(); ++count)
        static_cast<void>(take_tile(rest));
    } catch (const std::runtime_error&) {
      return false;
    }
    if (count != range.size()) return false;
    std::span<const std::byte> rest(payload_);
    for (std::uint64_t number = range.first; number < range.last; ++number) take_(number, take_tile(rest));
    result_.tiles += count;
    return true;
  }

  /// The place of the first magic word of a segment from there on, or the end.
  std::uint64_t find_segment(std::uint64_t from) {
    constexpr std::size_t kLook = 65536;
    std::string block;
    for (std::uint64_t at = from; at < bytes_; at += kLook) {
      // The blocks overlap by a word less one.
      block.resize(std::min<std::uint64_t>(kLook + kSegmentMagic.size() - 1, bytes_ - at));
      if (!load(at, std::as_writable_bytes(std::span(block)))) break;
      const std::size_t found = block.find(kSegmentMagic);
      if (found != std::string::npos) return at + found;
    }
    return bytes_;
  }

  bool load(std::uint64_t at, std::span<std::byte> bytes) {
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return static_cast<bool>(stream_);
  }

  template <class T>
  std::optional<T> load(std::uint64_t at) {
    T object;
    if (bytes_ < at + sizeof object || !load(at, std::as_writable_bytes(std::span(&object, 1))))
      return std::nullopt;
    return object;
  }

  std::istream& stream_;
  const StripFileKey& key_;
  const std::function<void(std::uint64_t, const TileView&)>& take_;
  std::uint64_t all_;  // tiles of the matrix
  std::uint64_t bytes_ = 0;
  bool damaged_header_ = false;
  bool ended_ = false;
  std::uint64_t lost_ = 0;  // segments
  std::vector<std::byte> payload_;
  StripFileResult result_;
};

}  // namespace

StripFileWriter::StripFileWriter(std::ostream& stream, const StripFileKey& key, std::uint32_t makers)
    : stream_(stream), key_(key) {
  FileHeader header{to_array(kFileMagic), kVersion, kTileSize, key.identity, key.elements, makers, 0};
  header.check = check_of(header);
  write(stream_, header);
}

void StripFileWriter::add(std::uint64_t number, const TileView& tile) {
  const bool full = payload_.size() + 1 + TileCode::kMaxBytes > kMaxPayload;
  if (full || number != range_.last) {
    if (range_.size() > 0) write_segment();
    range_ = {number, number};
  }
  append_tile(payload_, tile);
  ++range_.last;
  ++tiles_;
}

void StripFileWriter::finish() {
  if (range_.size() > 0) write_segment();
  range_ = {tiles_, tiles_};
  write_segment();
}

void StripFileWriter::write_segment() {
  SegmentHeader header{to_array(kSegmentMagic), range_, payload_.size(), hash_bytes(payload_), 0};
  header.check = check_of(header, key_.identity);
  write(stream_, header);
  stream_.write(reinterpret_cast<const char*>(payload_.data()),
                static_cast<std::streamsize>(payload_.size()));
  payload_.clear();
}

StripFileResult read_strip_file(std::istream& stream, const StripFileKey& key,
                                const std::function<void(std::uint64_t, const TileView&)>& take) {
  return StripFileReader(stream, key, take).read();
}

}  // namespace fluxel

#include "hierarchy/block_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <istream>
#include <ostream>
#include <string_view>

#include "core/hash.hpp"

namespace fluxel {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little endian");

constexpr std::string_view kMagic = "FLXBLOCK";
constexpr std::uint32_t kVersion = 1;

/// So much has to be in memory, and so finely are blocks shared out among ranks.
constexpr std::uint64_t kSegmentBlocks = 32768;

struct StoredBlock {
  NodeId p, q;
  float G, doubt;
  Slope over_p, over_q;
  std::uint32_t partial;
};
static_assert(sizeof(StoredBlock) == 24, "without padding");

struct Header {
  std::array<char, 8> magic;
  std::uint32_t version, block_bytes;
  std::uint64_t identity, round, blocks;
  RefinementCounts counts;
  std::uint64_t check;  // of what stands before
};
static_assert(sizeof(Header) == 16 + 8 * 8);

std::uint64_t check_of(const Header& header) {
  return hash_bytes(std::as_bytes(std::span(&header, 1)).first(offsetof(Header, check)));
}

/// A segment's check sum begins with the header's, so that none is taken for another file's.
std::uint64_t check_of(std::span<const StoredBlock> segment, const Header& header) {
  return hash_bytes(std::as_bytes(segment), header.check);
}

template <class T>
void write(std::ostream& stream, std::span<const T> items) {
  stream.write(reinterpret_cast<const char*>(items.data()), static_cast<std::streamsize>(items.size_bytes()));
}

template <class T>
bool read(std::istream& stream, std::span<T> items) {
  stream.read(reinterpret_cast<char*>(items.data()), static_cast<std::streamsize>(items.size_bytes()));
  return static_cast<bool>(stream);
}

constexpr std::uint64_t segments_of(std::uint64_t blocks) {
  return (blocks + kSegmentBlocks - 1) / kSegmentBlocks;
}

/// Where a segment begins in the file.
constexpr std::uint64_t place_of(std::uint64_t segment) {
  return sizeof(Header) + segment * (kSegmentBlocks * sizeof(StoredBlock) + sizeof(std::uint64_t));
}

/// How long a file has to be.
constexpr std::uint64_t file_bytes(std::uint64_t blocks) {
  return sizeof(Header) + blocks * sizeof(StoredBlock) + segments_of(blocks) * sizeof(std::uint64_t);
}

std::uint64_t size_of(std::istream& stream) {
  stream.seekg(0, std::ios::end);
  const std::streamoff end = stream.tellg();
  stream.seekg(0);
  return stream && end > 0 ? static_cast<std::uint64_t>(end) : 0;
}

/// What is wrong with the header of a file of so many bytes.
std::string defect_of(const Header& header, const BlockFileKey& key, std::uint64_t bytes) {
  if (std::string_view(header.magic.data(), header.magic.size()) != kMagic) return "is no file of blocks";
  if (header.check != check_of(header)) return "is damaged or cut off";
  if (header.version != kVersion || header.block_bytes != sizeof(StoredBlock))
    return fmt::format("is of another version of the format ({} where {} is needed)", header.version,
                       kVersion);
  if (BlockFileKey{header.identity, header.round} != key) return "is of another round or other options";
  if (header.blocks > bytes / sizeof(StoredBlock) || file_bytes(header.blocks) != bytes)
    return "is damaged or cut off";
  return {};
}

}  // namespace

void write_block_file(std::ostream& stream, const BlockFileKey& key, std::span<const Block> blocks,
                      const RefinementCounts& counts) {
  Header header{{}, kVersion, sizeof(StoredBlock), key.identity, key.round, blocks.size(), counts, 0};
  kMagic.copy(header.magic.data(), header.magic.size());
  header.check = check_of(header);
  write(stream, std::span<const Header>(&header, 1));
  std::vector<StoredBlock> segment;
  for (std::size_t first = 0; first < blocks.size() && stream; first += kSegmentBlocks) {
    segment.clear();
    for (const Block& b : blocks.subspan(first, std::min<std::size_t>(kSegmentBlocks, blocks.size() - first)))
      segment.push_back({b.p, b.q, b.G, b.doubt, b.over_p, b.over_q, b.partial ? 1u : 0u});
    const std::uint64_t check = check_of(segment, header);
    write(stream, std::span<const StoredBlock>(segment));
    write(stream, std::span(&check, 1));
  }
}

BlockFileResult read_block_file(std::istream& stream, const BlockFileKey& key, std::size_t nodes,
                                const std::function<bool(std::uint64_t)>& wanted) {
  BlockFileResult result;
  const std::uint64_t bytes = size_of(stream);
  Header header;
  if (!read(stream, std::span(&header, 1))) return {{}, {}, "is too short to be a file of blocks"};
  result.defect = defect_of(header, key, bytes);
  if (!result.defect.empty()) return result;
  result.counts = header.counts;
  std::vector<StoredBlock> segment;
  for (std::uint64_t k = 0; k < segments_of(header.blocks); ++k) {
    if (!wanted(k)) continue;
    segment.resize(std::min(kSegmentBlocks, header.blocks - k * kSegmentBlocks));
    std::uint64_t check = 0;
    stream.seekg(static_cast<std::streamoff>(place_of(k)));
    const bool intact = read(stream, std::span(segment)) && read(stream, std::span(&check, 1)) &&
                        check == check_of(segment, header) &&
                        std::ranges::all_of(segment, [nodes](const StoredBlock& block) {
                          return block.p < nodes && block.q < nodes;
                        });
    if (!intact) return {{}, {}, "is damaged or cut off"};
    for (const StoredBlock& s : segment)
      result.blocks.push_back({s.p, s.q, s.G, s.doubt, s.over_p, s.over_q, s.partial != 0});
  }
  return result;
}

}  // namespace fluxel

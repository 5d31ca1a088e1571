#include "hierarchy/link_file.hpp"

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

constexpr std::string_view kLinkMagic = "FLXLINKS";
constexpr std::uint32_t kLinkVersion = 1;

/// So much has to be in memory, and so finely are links shared out among ranks.
constexpr std::uint64_t kSegmentLinks = 32768;

struct StoredLink {
  NodeId p, q;
  float G, G_error;
  Slope over_p, over_q;
  std::uint32_t partial;
};
static_assert(sizeof(StoredLink) == 24, "without padding");

struct LinkHeader {
  std::array<char, 8> magic;
  std::uint32_t version, link_bytes;
  std::uint64_t identity, round, links;
  RefinementCounts counts;
  std::uint64_t check;  // of what stands before
};
static_assert(sizeof(LinkHeader) == 16 + 8 * 8);

std::uint64_t link_check_of(const LinkHeader& header) {
  return hash_bytes(std::as_bytes(std::span(&header, 1)).first(offsetof(LinkHeader, check)));
}

/// A segment's check sum begins with the header's, so that none is taken for another file's.
std::uint64_t link_check_of(std::span<const StoredLink> segment, const LinkHeader& header) {
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

constexpr std::uint64_t segments_of(std::uint64_t links) {
  return (links + kSegmentLinks - 1) / kSegmentLinks;
}

/// Where a segment begins in the file.
constexpr std::uint64_t place_of(std::uint64_t segment) {
  return sizeof(LinkHeader) + segment * (kSegmentLinks * sizeof(StoredLink) + sizeof(std::uint64_t));
}

/// How long a file has to be.
constexpr std::uint64_t file_bytes(std::uint64_t links) {
  return sizeof(LinkHeader) + links * sizeof(StoredLink) + segments_of(links) * sizeof(std::uint64_t);
}

std::uint64_t size_of(std::istream& stream) {
  stream.seekg(0, std::ios::end);
  const std::streamoff end = stream.tellg();
  stream.seekg(0);
  return stream && end > 0 ? static_cast<std::uint64_t>(end) : 0;
}

/// What is wrong with the header of a file of so many bytes.
std::string defect_of(const LinkHeader& header, const LinkFileKey& key, std::uint64_t bytes) {
  if (std::string_view(header.magic.data(), header.magic.size()) != kLinkMagic) return "is no file of links";
  if (header.check != link_check_of(header)) return "is damaged or cut off";
  if (header.version != kLinkVersion || header.link_bytes != sizeof(StoredLink))
    return fmt::format("is of another version of the format ({} where {} is needed)", header.version,
                       kLinkVersion);
  if (LinkFileKey{header.identity, header.round} != key) return "is of another round or other options";
  if (header.links > bytes / sizeof(StoredLink) || file_bytes(header.links) != bytes)
    return "is damaged or cut off";
  return {};
}

}  // namespace

void write_link_file(std::ostream& stream, const LinkFileKey& key, std::span<const Link> links,
                     const RefinementCounts& counts) {
  LinkHeader header{{}, kLinkVersion, sizeof(StoredLink), key.identity, key.round, links.size(), counts, 0};
  kLinkMagic.copy(header.magic.data(), header.magic.size());
  header.check = link_check_of(header);
  write(stream, std::span<const LinkHeader>(&header, 1));
  std::vector<StoredLink> segment;
  for (std::size_t first = 0; first < links.size() && stream; first += kSegmentLinks) {
    segment.clear();
    for (const Link& b : links.subspan(first, std::min<std::size_t>(kSegmentLinks, links.size() - first)))
      segment.push_back({b.p, b.q, b.G, b.G_error, b.over_p, b.over_q, b.partial ? 1u : 0u});
    const std::uint64_t check = link_check_of(segment, header);
    write(stream, std::span<const StoredLink>(segment));
    write(stream, std::span(&check, 1));
  }
}

LinkFileResult read_link_file(std::istream& stream, const LinkFileKey& key, std::size_t nodes,
                              const std::function<bool(std::uint64_t)>& wanted) {
  LinkFileResult result;
  const std::uint64_t bytes = size_of(stream);
  LinkHeader header;
  if (!read(stream, std::span(&header, 1))) return {{}, {}, "is too short to be a file of links"};
  result.defect = defect_of(header, key, bytes);
  if (!result.defect.empty()) return result;
  result.counts = header.counts;
  std::vector<StoredLink> segment;
  for (std::uint64_t k = 0; k < segments_of(header.links); ++k) {
    if (!wanted(k)) continue;
    segment.resize(std::min(kSegmentLinks, header.links - k * kSegmentLinks));
    std::uint64_t check = 0;
    stream.seekg(static_cast<std::streamoff>(place_of(k)));
    const bool intact = read(stream, std::span(segment)) && read(stream, std::span(&check, 1)) &&
                        check == link_check_of(segment, header) &&
                        std::ranges::all_of(segment, [nodes](const StoredLink& link) {
                          return link.p < nodes && link.q < nodes;
                        });
    if (!intact) return {{}, {}, "is damaged or cut off"};
    for (const StoredLink& s : segment)
      result.links.push_back({s.p, s.q, s.G, s.G_error, s.over_p, s.over_q, s.partial != 0});
  }
  return result;
}

}  // namespace fluxel

#include "visibility/strip_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <span>
#include <sstream>

#include "core/hash.hpp"
#include "visibility/tile_code.hpp"

namespace fluxel {
namespace {

constexpr std::size_t kHeaderBytes = 48;
constexpr std::size_t kSegmentHeaderBytes = 48;
constexpr std::size_t kMaxPayload = std::size_t{1} << 20;

/// A matrix of 100 tiles a side, 5050 in all.
constexpr StripFileKey kKey{0x1234, 100 * kTileSize};

using Bytes = std::vector<std::byte>;
using Tiles = std::map<std::uint64_t, std::pair<TileTag, Bytes>>;

/// Raw bits, of the greatest length that a code can have, or uniform.
std::pair<TileTag, Bytes> some_tile(std::mt19937_64& random, bool uniform) {
  if (uniform) return {static_cast<TileTag>(random() % 3), {}};
  TileBits bits;
  for (std::uint64_t& word : bits) word = random();
  const TileCode code = encode_tile(bits);
  return {TileTag::bits, Bytes(code.view().begin(), code.view().end())};
}

/// Tiles of all kinds, in two runs of numbers, of several segments the first.
Tiles some_tiles() {
  std::mt19937_64 random(7);
  Tiles tiles;
  for (std::uint64_t number = 10; number < 4510; ++number)
    tiles[number] = some_tile(random, number % 10 == 0);
  for (std::uint64_t number = 4700; number < 5050; ++number)
    tiles[number] = some_tile(random, number % 2 == 0);
  return tiles;
}

std::string file_of(const Tiles& tiles, const StripFileKey& key = kKey,
                    std::uint32_t makers = kMadeByProcessor) {
  std::ostringstream stream(std::ios::binary);
  StripFileWriter writer(stream, key, makers);
  for (const auto& [number, tile] : tiles) writer.add(number, {tile.first, tile.second});
  writer.finish();
  return stream.str();
}

struct Read {
  Tiles tiles;
  StripFileResult result;
};

Read read(const std::string& bytes, const StripFileKey& key = kKey) {
  std::istringstream stream(bytes, std::ios::binary);
  Read read;
  read.result = read_strip_file(stream, key, [&](std::uint64_t number, const TileView& tile) {
    const bool is_new =
        read.tiles.try_emplace(number, tile.tag, Bytes(tile.code.begin(), tile.code.end())).second;
    EXPECT_TRUE(is_new) << "tile " << number << " came twice";
  });
  EXPECT_EQ(read.result.tiles, read.tiles.size());
  return read;
}

/// Tiles that the file has and the reading has not; those that it has are as they were.
std::size_t missing(const Tiles& all, const Tiles& read) {
  for (const auto& [number, tile] : read) EXPECT_TRUE(all.at(number) == tile) << number;
  return all.size() - read.size();
}

TEST(StripFile, GivesBackWhatWasWritten) {
  const Tiles tiles = some_tiles();
  const Read back = read(file_of(tiles));
  EXPECT_EQ(back.result.defect, "");
  EXPECT_TRUE(back.tiles == tiles);
}

TEST(StripFile, NamesItsMakers) {
  for (const std::uint32_t makers : {kMadeByProcessor + 0u, kMadeByGpu + 0u, kMadeByProcessor | kMadeByGpu}) {
    std::string bytes = file_of(some_tiles(), kKey, makers);
    EXPECT_EQ(read(bytes).result.makers, makers);
    bytes[20] = static_cast<char>(bytes[20] ^ 1);  // in the header
    const Read damaged = read(bytes);
    EXPECT_GT(damaged.result.tiles, 0u);
    EXPECT_EQ(damaged.result.makers, kMadeByProcessor | kMadeByGpu) << "nobody knows";
  }
  EXPECT_EQ(read(file_of(some_tiles(), {1, 6400})).result.makers, 0u) << "nothing is taken";
}

TEST(StripFile, MayHoldNoTile) {
  const Read back = read(file_of({}));
  EXPECT_EQ(back.result.defect, "");
  EXPECT_TRUE(back.tiles.empty());
}

TEST(StripFile, SaysTheSameInTheSameBytes) { EXPECT_EQ(file_of(some_tiles()), file_of(some_tiles())); }

TEST(StripFile, TakesAByteForAUniformTile) {
  Tiles tiles;
  for (std::uint64_t number = 0; number < 5050; ++number) tiles[number] = {TileTag::visible, {}};
  EXPECT_EQ(file_of(tiles).size(), kHeaderBytes + 2 * kSegmentHeaderBytes + 5050);
}

TEST(StripFile, ADamagedByteLosesOneSegment) {
  const Tiles tiles = some_tiles();
  const std::string whole = file_of(tiles);
  ASSERT_GT(whole.size(), 2 * kMaxPayload) << "several segments";
  std::mt19937_64 random(3);
  std::size_t most = 0;
  for (int repeat = 0; repeat < 60; ++repeat) {
    // Every byte of the first two headers, then anywhere.
    const std::size_t at =
        repeat < 20 ? random() % (kHeaderBytes + kSegmentHeaderBytes) : random() % whole.size();
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 << random() % 8));
    const Read back = read(bytes);
    EXPECT_EQ(back.result.defect, "is damaged or cut off") << "byte " << at;
    const std::size_t lost = missing(tiles, back.tiles);
    EXPECT_LT(lost, tiles.size() / 2) << "byte " << at;
    if (at < kHeaderBytes) {
      EXPECT_EQ(lost, 0u) << "byte " << at;
    }
    most = std::max(most, lost);
  }
  EXPECT_GT(most, 0u);
}

TEST(StripFile, EveryCutIsSeenAndLosesNothingBeforeIt) {
  Tiles tiles;
  std::mt19937_64 random(5);
  for (std::uint64_t number = 0; number < 40; ++number)
    tiles[3 * number] = some_tile(random, number % 2 == 0);
  const std::string whole = file_of(tiles);
  std::size_t last = tiles.size();
  for (std::size_t size = whole.size() - 1; size > 0; --size) {
    const Read back = read(whole.substr(0, size));
    EXPECT_NE(back.result.defect, "") << size << " bytes of " << whole.size();
    const std::size_t lost = missing(tiles, back.tiles);
    EXPECT_LE(back.tiles.size(), last) << size;
    last = tiles.size() - lost;
  }
  EXPECT_EQ(last, 0u);
  // The last segment is intact as long as its bytes are there.
  EXPECT_EQ(read(whole.substr(0, whole.size() - 1)).tiles.size(), tiles.size());
}

TEST(StripFile, WhatStandsBehindTheEndIsSeen) {
  EXPECT_EQ(read(file_of(some_tiles()) + '\0').result.defect, "is damaged or cut off");
}

TEST(StripFile, ForeignFilesAreNamed) {
  const std::string whole = file_of(some_tiles());
  const std::string foreign = "is of another scene, other elements or another instruction set";
  for (const StripFileKey& key : {StripFileKey{0x1235, kKey.elements}, StripFileKey{kKey.identity, 6401}}) {
    const Read back = read(whole, key);
    EXPECT_EQ(back.result.defect, foreign);
    EXPECT_TRUE(back.tiles.empty());
  }
  EXPECT_EQ(read("").result.defect, "is too short to be a file of strips");
  EXPECT_EQ(read(std::string(5000, 'x')).result.defect, "is no file of strips");
}

TEST(StripFile, AnotherVersionIsNamedAndNotTaken) {
  std::string bytes = file_of(some_tiles());
  bytes[8] = 3;
  const std::uint64_t check = hash_bytes(std::as_bytes(std::span(bytes).first(40)));
  std::memcpy(bytes.data() + 40, &check, sizeof check);
  const Read back = read(bytes);
  EXPECT_EQ(back.result.defect, "is of another version of the format (3 where 2 is needed)");
  EXPECT_TRUE(back.tiles.empty());
}

TEST(StripFile, SegmentsOfAForeignFileAreNotTakenWhereItsHeaderIsDamaged) {
  std::string bytes = file_of(some_tiles(), {0x1235, kKey.elements});
  bytes[16] = static_cast<char>(bytes[16] ^ 1);
  const Read back = read(bytes);
  EXPECT_TRUE(back.tiles.empty());
  EXPECT_EQ(back.result.defect, "is damaged or cut off");
}

TEST(StripFile, TilesOutsideTheMatrixAreNotTaken) {
  const Read back = read(file_of({{5040, {TileTag::visible, {}}}, {5050, {TileTag::visible, {}}}}));
  EXPECT_EQ(back.tiles.size(), 1u);
  EXPECT_EQ(back.result.defect, "is damaged or cut off");
}

TEST(StripFile, WhateverStandsThereIsTakenOrRefused) {
  Tiles tiles;
  std::mt19937_64 random(11);
  for (std::uint64_t number = 0; number < 30; ++number)
    tiles[2 * number] = some_tile(random, number % 3 == 0);
  const std::string whole = file_of(tiles);
  for (int repeat = 0; repeat < 3000; ++repeat) {
    std::string bytes = whole.substr(0, random() % 4 == 0 ? random() % whole.size() : whole.size());
    for (std::uint64_t k = random() % 8; k > 0 && !bytes.empty(); --k)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    missing(tiles, read(bytes).tiles);
  }
}

}  // namespace
}  // namespace fluxel

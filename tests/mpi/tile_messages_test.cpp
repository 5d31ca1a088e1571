#include "mpi_master/scheduling/tile_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

namespace fluxel::test {
namespace {

constexpr std::size_t kHeaderBytes = 24;

/// With rows that alternate between `different` ones.
CodedTile mixed_tile(std::mt19937_64& random, std::size_t different) {
  TileBits bits;
  for (std::size_t row = 0; row < kTileSize; ++row)
    bits[row] = row < different ? random() : bits[row % different];
  return {TileTag::bits, encode_tile(bits)};
}

std::vector<CodedTile> tiles_of_all_kinds() {
  std::mt19937_64 random(7);
  return {{TileTag::blocked, {}},
          mixed_tile(random, kTileSize),
          {TileTag::visible, {}},
          {TileTag::facing_away, {}},
          mixed_tile(random, 3)};
}

struct Taken {
  std::size_t row, column;
  TileTag tag;
  Bytes code;
};

std::vector<Taken> decode(const Bytes& bytes) {
  std::vector<Taken> all;
  decode_tiles(bytes, [&](std::size_t row, std::size_t column, TileTag tag, std::span<const std::byte> code) {
    all.push_back({row, column, tag, Bytes(code.begin(), code.end())});
  });
  return all;
}

Bytes message_of(std::size_t row, std::size_t first_column, std::span<const CodedTile> tiles) {
  Bytes message;
  append_tiles(message, row, first_column, tiles);
  return message;
}

void expect_equal(std::span<const Taken> taken, std::size_t row, std::size_t column,
                  std::span<const CodedTile> sent) {
  ASSERT_EQ(taken.size(), sent.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    EXPECT_EQ(taken[k].row, row);
    EXPECT_EQ(taken[k].column, column + k);
    EXPECT_EQ(taken[k].tag, sent[k].tag);
    EXPECT_TRUE(std::ranges::equal(taken[k].code, sent[k].code.view()));
  }
}

TEST(TileMessages, TilesArriveAsTheyWere) {
  const std::vector<CodedTile> sent = tiles_of_all_kinds();
  // Beyond 32 bits, where a narrower header would show.
  const std::size_t row = (std::size_t{1} << 40) + 3, column = (std::size_t{1} << 41) + 5;
  expect_equal(decode(message_of(row, column, sent)), row, column, sent);
}

TEST(TileMessages, AMessageMayHaveSeveralParts) {
  const std::vector<CodedTile> sent = tiles_of_all_kinds();
  Bytes message = message_of(3, 4, sent);
  append_tiles(message, 5, 6, std::span(sent).first(0));
  append_tiles(message, 7, 8, std::span(sent).first(2));
  const std::vector<Taken> taken = decode(message);
  ASSERT_EQ(taken.size(), sent.size() + 2);
  expect_equal(std::span(taken).first(sent.size()), 3, 4, sent);
  expect_equal(std::span(taken).last(2), 7, 8, std::span(sent).first(2));
}

TEST(TileMessages, UniformTilesTakeOneByteEach) {
  const std::vector<CodedTile> uniform(1000, CodedTile{TileTag::visible, {}});
  EXPECT_EQ(message_of(0, 0, uniform).size(), kHeaderBytes + 1000);
  EXPECT_TRUE(decode(message_of(0, 0, std::span(uniform).first(0))).empty());
  EXPECT_TRUE(decode({}).empty());
}

TEST(TileMessages, EveryTruncationIsRefused) {
  const Bytes whole = message_of(3, 4, tiles_of_all_kinds());
  for (std::size_t size = 1; size < whole.size(); ++size)
    EXPECT_THROW(decode(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                 std::runtime_error)
        << size << " bytes of " << whole.size();
}

TEST(TileMessages, TrailingBytesAreRefused) {
  Bytes bytes = message_of(3, 4, tiles_of_all_kinds());
  bytes.push_back(std::byte{0});
  EXPECT_THROW(decode(bytes), std::runtime_error);
}

TEST(TileMessages, UnknownTagsAreRefused) {
  const std::vector<CodedTile> one{{TileTag::visible, {}}};
  Bytes bytes = message_of(3, 4, one);
  for (const int tag : {4, 127, 255}) {
    bytes.back() = static_cast<std::byte>(tag);
    EXPECT_THROW(decode(bytes), std::runtime_error) << tag;
  }
}

TEST(TileMessages, ACountBeyondTheBytesIsRefusedAtOnce) {
  const std::vector<CodedTile> none;
  Bytes bytes = message_of(3, 4, none);
  const std::uint64_t count = ~std::uint64_t{0};
  std::memcpy(bytes.data() + bytes.size() - sizeof count, &count, sizeof count);
  EXPECT_THROW(decode(bytes), std::runtime_error);
}

TEST(TileMessages, DamagedCodesAreRefused) {
  std::mt19937_64 random(5);
  const std::vector<CodedTile> one{mixed_tile(random, 3)};
  Bytes bytes = message_of(3, 4, one);
  bytes[kHeaderBytes + 1] ^= std::byte{0x3F};  // another number of different rows than the map has
  EXPECT_THROW(decode(bytes), std::runtime_error);
}

TEST(TileMessages, WhateverArrivesIsTakenOrRefused) {
  const Bytes whole = message_of(3, 4, tiles_of_all_kinds());
  std::mt19937_64 random(17);
  for (int repeat = 0; repeat < 20000; ++repeat) {
    Bytes bytes = whole;
    for (std::uint64_t k = 1 + random() % 3; k > 0; --k)
      bytes[random() % bytes.size()] ^= static_cast<std::byte>(1 + random() % 255);
    try {
      for (const Taken& tile : decode(bytes)) {
        if (tile.tag != TileTag::bits) continue;
        EXPECT_EQ(checked_code_size(tile.code), tile.code.size());
      }
    } catch (const std::runtime_error&) {
    }
  }
}

}  // namespace
}  // namespace fluxel::test

#include "visibility/tile_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

namespace fluxel {
namespace {

using Random = std::mt19937_64;

TileBits tile_of(const std::function<bool(std::size_t, std::size_t)>& sees) {
  TileBits bits{};
  for (std::size_t row = 0; row < kTileSize; ++row)
    for (std::size_t column = 0; column < kTileSize; ++column)
      bits[row] |= std::uint64_t{sees(row, column)} << column;
  return bits;
}

TileBits random_tile(Random& random, double density) {
  std::bernoulli_distribution sees(density);
  return tile_of([&](std::size_t, std::size_t) { return sees(random); });
}

/// Rows and columns drawn, in any order, from a few.
TileBits repeating_tile(Random& random, std::size_t rows, std::size_t columns) {
  const TileBits few = random_tile(random, 0.5);
  std::array<std::size_t, kTileSize> row, column;
  for (std::size_t k = 0; k < kTileSize; ++k) {
    const bool stays = k > 0 && random() % 2 == 0;
    row[k] = stays ? row[k - 1] : random() % rows;
    column[k] = stays ? column[k - 1] : random() % columns;
  }
  return tile_of([&](std::size_t r, std::size_t c) { return (few[row[r]] >> column[c] & 1u) != 0; });
}

/// A code as it stands in a store or a message: its own bytes, then whatever comes next.
std::vector<std::byte> followed_by_ones(const TileCode& code) {
  std::vector<std::byte> bytes(code.view().begin(), code.view().end());
  bytes.insert(bytes.end(), TileCode::kPadding, std::byte{0xFF});
  return bytes;
}

void expect_round_trip(const TileBits& bits) {
  const TileCode code = encode_tile(bits);
  ASSERT_LE(code.size, TileCode::kMaxBytes);
  const std::vector<std::byte> stored = followed_by_ones(code);
  TileBits decoded;
  decode_tile(stored.data(), decoded);
  ASSERT_EQ(decoded, bits);
  ASSERT_EQ(checked_code_size(stored), code.size);
  ASSERT_EQ(checked_code_size(code.view()), code.size);
}

/// Tiles of all kinds, from a few bytes to raw bits.
std::vector<TileBits> many_tiles() {
  Random random(3);
  std::vector<TileBits> tiles;
  for (const double density : {0.0, 0.0003, 0.003, 0.03, 0.1, 0.3, 0.5, 0.7, 0.97, 0.9997, 1.0})
    for (int repeat = 0; repeat < 20; ++repeat) tiles.push_back(random_tile(random, density));
  for (std::size_t rows = 1; rows <= kTileSize; ++rows)
    for (const std::size_t columns : {std::size_t{1}, rows, kTileSize + 1 - rows, kTileSize})
      tiles.push_back(repeating_tile(random, rows, columns));
  for (std::size_t k = 1; k < kTileSize; ++k) {
    tiles.push_back(tile_of([k](std::size_t r, std::size_t) { return r < k; }));
    tiles.push_back(tile_of([k](std::size_t, std::size_t c) { return c >= k; }));
    tiles.push_back(tile_of([k](std::size_t r, std::size_t c) { return r + c < k; }));
    tiles.push_back(tile_of([k](std::size_t r, std::size_t c) { return r / k % 2 == c / k % 2; }));
    tiles.push_back(tile_of([k](std::size_t r, std::size_t c) { return r == k && c == 63 - k; }));
  }
  tiles.push_back(tile_of([](std::size_t r, std::size_t c) { return r == c; }));
  return tiles;
}

TEST(TileCode, GivesBackEveryKindOfTile) {
  for (const TileBits& bits : many_tiles()) ASSERT_NO_FATAL_FAILURE(expect_round_trip(bits));
}

TEST(TileCode, GivesBackEveryPatternOfFourByFour) {
  for (std::size_t pattern = 0; pattern < 65536; ++pattern) {
    const std::size_t row = pattern % 61, column = pattern / 61 % 61;
    const bool around = pattern % 7 < 3;
    const TileBits bits = tile_of([&](std::size_t r, std::size_t c) {
      if (r < row || r >= row + 4 || c < column || c >= column + 4) return around;
      return (pattern >> (4 * (r - row) + (c - column)) & 1u) != 0;
    });
    ASSERT_NO_FATAL_FAILURE(expect_round_trip(bits));
    // Counts; two maps with at most 5 changes, of which at most one, or some between the four, lead back to
    // what was before; 5 x 5 bits.
    ASSERT_LE(encode_tile(bits).size, (12u + 2 * (63 + 5 + 4 * 3) + 25 + 7) / 8);
  }
}

TEST(TileCode, NoiseKeepsRawBits) {
  Random random(5);
  EXPECT_EQ(encode_tile(random_tile(random, 0.5)).size, TileCode::kMaxBytes);
}

/// Rows 0..19 and 40..63 see columns 32..63, the others columns 0..31.
TileBits three_bands() {
  return tile_of([](std::size_t r, std::size_t c) { return (c >= 32) != (r >= 20 && r < 40); });
}

// Where in the code of the bands the parts begin [bits].
constexpr std::size_t kRowMap = 12, kRowIsNew = kRowMap + 63, kRowOld = kRowIsNew + 2;
constexpr std::size_t kColumnMap = kRowOld + 1, kColumnIsNew = kColumnMap + 63, kMatrix = kColumnIsNew + 1;

void flip(TileCode& code, std::size_t bit) { code.bytes[bit / 8] ^= std::byte{1} << bit % 8; }

TEST(TileCode, TheLayoutIsAsDescribed) {
  TileCode code = encode_tile(three_bands());
  EXPECT_EQ(code.size, (kMatrix + 4 + 7) / 8);
  // Two different rows and columns; row 20 differs and is new, row 40 differs and is like different row 0;
  // column 32 differs and is new; the first column is seen by different row 1, the second by 0.
  for (const std::size_t bit : {std::size_t{0}, std::size_t{6}, kRowMap + 19, kRowMap + 39, kRowIsNew,
                                kColumnMap + 31, kColumnIsNew, kMatrix + 1, kMatrix + 2})
    flip(code, bit);
  for (const std::byte byte : code.bytes) EXPECT_EQ(byte, std::byte{0});
}

TEST(TileCode, TruncatedCodesAreRefused) {
  for (const TileBits& bits : many_tiles()) {
    const TileCode code = encode_tile(bits);
    for (std::size_t size = 0; size < code.size; size += 1 + size / 16) {
      // In memory of their own, where a sanitizer sees what is read beyond.
      const std::vector<std::byte> front(code.bytes.begin(),
                                         code.bytes.begin() + static_cast<std::ptrdiff_t>(size));
      ASSERT_THROW((void)checked_code_size(front), std::runtime_error) << size << " of " << code.size;
    }
  }
}

TEST(TileCode, DamagedMapsAreRefused) {
  const auto refused = [](std::initializer_list<std::size_t> flipped) {
    TileCode code = encode_tile(three_bands());
    for (const std::size_t bit : flipped) flip(code, bit);
    try {
      return checked_code_size(std::span(code.bytes)) == 0;
    } catch (const std::runtime_error&) {
      return true;
    }
  };
  EXPECT_FALSE(refused({}));
  EXPECT_FALSE(refused({kRowIsNew, kRowIsNew + 1})) << "row 20 is like 0, row 40 is new";
  EXPECT_TRUE(refused({kRowIsNew, kRowIsNew + 1, kRowOld})) << "row 20 is like one that comes later";
  EXPECT_TRUE(refused({kRowIsNew + 1})) << "more rows are new than there are";
  EXPECT_TRUE(refused({kColumnIsNew})) << "no column is new";
  EXPECT_TRUE(refused({1})) << "four rows, of which two come";
}

TEST(TileCode, RandomBytesAreRefusedOrDecoded) {
  Random random(9);
  std::size_t accepted = 0;
  for (int repeat = 0; repeat < 200000; ++repeat) {
    std::vector<std::byte> bytes(random() % 100);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    // Few lines and few changes, or hardly any of them would be valid.
    if (bytes.size() > 20 && repeat % 2 == 0) {
      bytes[0] &= std::byte{0xC1};
      bytes[1] &= std::byte{0x00};
      std::fill_n(bytes.begin() + 2, 16, std::byte{0});
      bytes[random() % 18] |= std::byte{1} << static_cast<int>(random() % 8);
    }
    std::size_t size = 0;
    try {
      size = checked_code_size(bytes);
    } catch (const std::runtime_error&) {
      continue;
    }
    ++accepted;
    ASSERT_LE(size, bytes.size());
    std::vector<std::byte> stored(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    stored.resize(size + TileCode::kPadding);
    TileBits bits;
    decode_tile(stored.data(), bits);
    // What it says in whatever way has a code of its own.
    ASSERT_NO_FATAL_FAILURE(expect_round_trip(bits));
  }
  EXPECT_GT(accepted, 100u);
}

}  // namespace
}  // namespace fluxel

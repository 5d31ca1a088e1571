#include "visibility/tile_store.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <stdexcept>

namespace fluxel {
namespace {

/// Rows alternate between `different` random ones.
TileBits random_tile(std::mt19937_64& random, std::size_t different, bool symmetric) {
  TileBits bits;
  for (std::size_t row = 0; row < kTileSize; ++row)
    bits[row] = row < different ? random() : bits[row % different];
  if (symmetric) {
    TileBits transposed = bits;
    transpose(transposed);
    for (std::size_t row = 0; row < kTileSize; ++row) bits[row] |= transposed[row];
  }
  return bits;
}

TEST(TileStore, GivesBackWhatWasPutInBothDirections) {
  // Enough mixed tiles for the pool to grow more than once.
  constexpr std::size_t kTiles = 70;
  for (const TileRows owned : {TileRows{0, kTiles}, TileRows{20, 60}, TileRows{69, 70}, TileRows{0, 1}}) {
    std::mt19937_64 random(7);
    TileStore store(kTiles, owned);
    std::map<std::pair<std::size_t, std::size_t>, std::pair<TileTag, TileBits>> truth;
    std::size_t codes = 0;
    for (std::size_t row = 0; row < kTiles; ++row) {
      for (std::size_t column = row; column < kTiles; ++column) {
        if (!owned.contains(row) && !owned.contains(column)) continue;
        const auto tag = random() % 8 == 0 ? static_cast<TileTag>(random() % 3) : TileTag::bits;
        TileBits bits = random_tile(random, 1 + random() % kTileSize, row == column);
        EXPECT_FALSE(store.has(row, column));
        store.put(row, column, tag, bits);
        EXPECT_TRUE(store.has(column, row));
        if (tag == TileTag::bits) codes += TileStore::pool_bytes(encode_tile(bits).size);
        if (tag != TileTag::bits) bits.fill(tag == TileTag::visible ? ~std::uint64_t{0} : 0);
        truth[{row, column}] = {tag, bits};
      }
    }
    std::size_t mixed = 0;
    for (const auto& [place, tile] : truth) {
      mixed += tile.first == TileTag::bits ? 1 : 0;
      TileBits read;
      EXPECT_EQ(store.tag(place.first, place.second), tile.first);
      EXPECT_EQ(store.tag(place.second, place.first), tile.first);
      const TileView view = store.view(place.first, place.second);
      EXPECT_EQ(view.tag, tile.first);
      const TileCode code = tile.first == TileTag::bits ? encode_tile(tile.second) : TileCode{};
      EXPECT_TRUE(std::ranges::equal(view.code, code.view()));
      store.read(place.first, place.second, read);
      EXPECT_EQ(read, tile.second);
      store.read(place.second, place.first, read);
      TileBits transposed = tile.second;
      transpose(transposed);
      EXPECT_EQ(read, transposed);
    }
    EXPECT_EQ(store.held(), truth.size());
    EXPECT_EQ(store.expected(), truth.size());
    EXPECT_EQ(store.mixed(), mixed);
    // The codes, one entry an owned row and column, what no code fits in at the end of a chunk, and at most
    // one chunk more.
    const std::size_t table = owned.size() * kTiles * sizeof(std::uint32_t);
    EXPECT_EQ(TileStore::bytes_for(kTiles, owned, 0), table);
    EXPECT_GE(store.bytes(), TileStore::bytes_for(kTiles, owned, codes));
    EXPECT_LT(static_cast<double>(store.bytes()),
              static_cast<double>(table) + 1.04 * static_cast<double>(codes) + 17000);
  }
}

TEST(TileStore, TheMostBytesAreNeverExceeded) {
  std::mt19937_64 random(11);
  for (const std::size_t different : {std::size_t{2}, std::size_t{33}, std::size_t{40}, kTileSize}) {
    constexpr std::size_t kTiles = 80;
    TileStore store(kTiles, {0, kTiles});
    const std::size_t table = store.bytes();
    for (std::size_t row = 0; row < kTiles; ++row) {
      for (std::size_t column = row; column < kTiles; ++column)
        store.put(row, column, TileTag::bits, random_tile(random, different, false));
      ASSERT_LE(store.bytes() - table, TileStore::max_bytes(store.held()));
    }
    if (different < kTileSize) continue;
    // Raw bits come near it.
    const auto most = static_cast<double>(TileStore::max_bytes(store.held()));
    EXPECT_GT(static_cast<double>(store.bytes() - table), 0.93 * most);
  }
  EXPECT_EQ(TileStore::max_bytes(0), 0u);
}

TEST(TileStore, ACodeIsTakenAsItIs) {
  std::mt19937_64 random(13);
  const TileBits bits = random_tile(random, 9, false);
  const TileCode code = encode_tile(bits);
  TileStore store(4, {1, 3});
  store.put(0, 1, TileTag::bits, code.view());
  TileBits read;
  store.read(0, 1, read);
  EXPECT_EQ(read, bits);
}

TEST(TileStore, ATileComesOnce) {
  TileStore store(4, {1, 3});
  const TileBits bits{};
  store.put(0, 1, TileTag::bits, bits);
  store.put(1, 2, TileTag::visible, bits);
  EXPECT_THROW(store.put(0, 1, TileTag::bits, bits), std::logic_error);
  EXPECT_THROW(store.put(1, 2, TileTag::blocked, bits), std::logic_error);
  EXPECT_EQ(store.held(), 2u);
  EXPECT_EQ(store.expected(), 7u);  // 0-1 0-2 1-1 1-2 1-3 2-2 2-3
}

TEST(TileStore, MoreCodesThanTheTableCanNameAreRefused) {
  constexpr std::size_t kMax = (std::size_t{1} << 32) - 5;  // four values are tags, or none
  EXPECT_EQ(TileStore::place_of(0), 4u);
  EXPECT_EQ(TileStore::place_of(kMax), 0xFFFFFFFFu);
  EXPECT_THROW((void)TileStore::place_of(kMax + 1), std::length_error);
}

TEST(TileStore, AMissingTileIsNoticed) {
  TileStore store(4, {1, 3});
  EXPECT_THROW((void)store.tag(1, 2), std::logic_error);
  EXPECT_THROW((void)store.tag(2, 1), std::logic_error);
  store.put(1, 2, TileTag::blocked, TileBits{});
  EXPECT_EQ(store.tag(2, 1), TileTag::blocked);
}

TEST(TileStore, ATileOfOtherRowsIsRefused) {
  TileStore store(6, {2, 4});
  EXPECT_THROW(store.put(0, 1, TileTag::visible, TileBits{}), std::logic_error);
  EXPECT_THROW(store.put(0, 5, TileTag::visible, TileBits{}), std::logic_error);
  EXPECT_THROW(store.put(2, 6, TileTag::visible, TileBits{}), std::logic_error);
  EXPECT_THROW(store.put(4, 5, TileTag::visible, TileBits{}), std::logic_error);
  EXPECT_EQ(store.held(), 0u);
}

}  // namespace
}  // namespace fluxel

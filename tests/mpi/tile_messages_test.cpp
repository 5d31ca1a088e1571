#include "mpi_master/tile_messages.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace fluxel::test {
namespace {

TracedTile mixed_tile(std::mt19937_64& random) {
  TracedTile tile;
  tile.tag = TileTag::bits;
  for (std::uint64_t& word : tile.bits) word = random();
  return tile;
}

std::vector<TracedTile> tiles_of_all_kinds() {
  std::mt19937_64 random(7);
  return {{TileTag::blocked, {}, 1},
          mixed_tile(random),
          {TileTag::visible, {}, 1},
          {TileTag::facing_away, {}, 0},
          mixed_tile(random)};
}

struct Taken {
  std::size_t row, column;
  TileTag tag;
  TileBits bits;
};

std::vector<Taken> decode(const Bytes& bytes) {
  std::vector<Taken> all;
  decode_tiles(bytes, [&](std::size_t row, std::size_t column, TileTag tag, const TileBits& bits) {
    all.push_back({row, column, tag, bits});
  });
  return all;
}

TEST(TileMessages, TilesArriveAsTheyWere) {
  const std::vector<TracedTile> sent = tiles_of_all_kinds();
  // Beyond 32 bits, where a narrower header would show.
  const std::size_t row = (std::size_t{1} << 40) + 3, column = (std::size_t{1} << 41) + 5;
  const std::vector<Taken> taken = decode(encode_tiles(row, column, sent));
  ASSERT_EQ(taken.size(), sent.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    EXPECT_EQ(taken[k].row, row);
    EXPECT_EQ(taken[k].column, column + k);
    EXPECT_EQ(taken[k].tag, sent[k].tag);
    if (sent[k].tag != TileTag::bits) continue;
    EXPECT_EQ(taken[k].bits, sent[k].bits);
  }
}

TEST(TileMessages, UniformTilesTakeOneByteEach) {
  const std::vector<TracedTile> uniform(1000, TracedTile{TileTag::visible, {}, 0});
  const std::vector<TracedTile> none;
  EXPECT_EQ(encode_tiles(0, 0, uniform).size(), encode_tiles(0, 0, none).size() + 1000);
  EXPECT_TRUE(decode(encode_tiles(0, 0, none)).empty());
}

TEST(TileMessages, EveryTruncationIsRefused) {
  const Bytes whole = encode_tiles(3, 4, tiles_of_all_kinds());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(decode(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
                 std::runtime_error)
        << size << " bytes of " << whole.size();
}

TEST(TileMessages, TrailingBytesAreRefused) {
  Bytes bytes = encode_tiles(3, 4, tiles_of_all_kinds());
  bytes.push_back(std::byte{0});
  EXPECT_THROW(decode(bytes), std::runtime_error);
}

TEST(TileMessages, UnknownTagsAreRefused) {
  const std::vector<TracedTile> one{{TileTag::visible, {}, 0}};
  Bytes bytes = encode_tiles(3, 4, one);
  for (const int tag : {4, 127, 255}) {
    bytes.back() = static_cast<std::byte>(tag);
    EXPECT_THROW(decode(bytes), std::runtime_error) << tag;
  }
}

TEST(TileMessages, ACountBeyondTheBytesIsRefusedAtOnce) {
  const std::vector<TracedTile> none;
  Bytes bytes = encode_tiles(3, 4, none);
  const std::uint64_t count = ~std::uint64_t{0};
  std::memcpy(bytes.data() + bytes.size() - sizeof count, &count, sizeof count);
  EXPECT_THROW(decode(bytes), std::runtime_error);
}

}  // namespace
}  // namespace fluxel::test

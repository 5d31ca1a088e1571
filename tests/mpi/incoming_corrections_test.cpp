#include "mpi_master/steps/incoming_corrections.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fluxel::test {
namespace {

TEST(IncomingCorrections, EndBeforeTheMemoryDoes) {
  constexpr std::uint64_t kMemory = 100'000'000;
  const std::vector<CorrectionEntry> batch(1000, {0, 1, 1.0f});
  std::size_t added = 0;
  int questions = 0;
  IncomingCorrections incoming([&] {
    ++questions;
    return kMemory - added * sizeof(CorrectionEntry);
  });
  while (incoming.has_room()) {
    incoming.add(batch);
    added += batch.size();
    ASSERT_LT(added * kFoundCorrectionBytes, kMemory) << "what compressing takes is not there any more";
  }
  EXPECT_EQ(incoming.size(), added);
  EXPECT_GT(added * kFoundCorrectionBytes, kMemory / 2) << "what was there has not been used";
  EXPECT_LT(questions, 40);
}

TEST(IncomingCorrections, AreCompressedAsTheyCame) {
  // Of several parts, rows descending and columns by a step that meets each once.
  constexpr std::uint32_t kRows = 300, kColumns = 701;
  IncomingCorrections incoming([] { return ~std::uint64_t{0}; });
  for (std::uint32_t row = kRows; row-- > 1;)
    for (std::uint32_t k = 0; k < kColumns; ++k) {
      const std::uint32_t column = k * 5 % kColumns;
      const CorrectionEntry entry{row, column, static_cast<float>(row * kColumns + column)};
      incoming.add(std::span(&entry, 1));
    }
  ASSERT_GT(incoming.size(), 200'000u);
  const Corrections found = incoming.compressed(kRows);
  EXPECT_EQ(incoming.size(), 0u);
  ASSERT_EQ(found.start.size(), kRows + 1);
  EXPECT_EQ(found.start[1], 0u) << "the first row has none";
  ASSERT_EQ(found.column.size(), (kRows - 1) * kColumns);
  for (std::uint32_t row = 1; row < kRows; ++row) {
    ASSERT_EQ(found.start[row + 1], std::uint64_t{row} * kColumns);
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      ASSERT_EQ(found.column[found.start[row] + column], column);
      ASSERT_EQ(found.G[found.start[row] + column], static_cast<float>(row * kColumns + column));
    }
  }
}

}  // namespace
}  // namespace fluxel::test

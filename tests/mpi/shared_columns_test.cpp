#include "mpi_master/communication/shared_columns.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "host_shapes.hpp"

namespace fluxel::test {
namespace {

std::vector<Element> some_elements(std::size_t count) {
  std::vector<Element> elements(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = static_cast<float>(i + 1);
    elements[i].centroid = {number, 2 / number, -3 * number};
    elements[i].area = 1 / number;
    elements[i].normal = {0, 0, i % 2 == 0 ? 1.0f : -1.0f};
    elements[i].elongation = {0.1f, 0.01f * number, 0};
    elements[i].minor_variance = 0.02f * number;
  }
  return elements;
}

TEST(SharedColumns, AreThoseThatOneRankMakes) {
  for (const HostShape& shape : host_shapes()) {
    // Fewer tiles than ranks, many, a full last tile.
    for (const std::size_t count : {std::size_t{5}, std::size_t{1000}, 8 * kTileSize}) {
      SCOPED_TRACE(shape.name);
      const std::vector<Element> elements = some_elements(count);
      const PairColumns expected(elements);
      const SharedColumns columns(shape.world.host(), elements);
      const PairColumnsView view = columns.view();
      ASSERT_EQ(view.tiles.size(), expected.tiles.size());
      EXPECT_EQ(std::memcmp(view.tiles.data(), expected.tiles.data(), view.tiles.size_bytes()), 0);
      EXPECT_TRUE(std::ranges::equal(view.area, expected.area));
      shape.world.barrier();
    }
  }
}

}  // namespace
}  // namespace fluxel::test

#include "method/coarser_solutions.hpp"

#include <gtest/gtest.h>

namespace fluxel::test {
namespace {

TEST(CoarserSolutions, PartsHaveTheValueOfTheWhole) {
  const std::vector<std::uint32_t> first{0, 3, 4};
  const std::vector<Rgb> fronts{Rgb(1), Rgb(2)};
  EXPECT_EQ(on_parts(fronts, first), (std::vector<Rgb>{Rgb(1), Rgb(1), Rgb(1), Rgb(2)}));
}

TEST(CoarserSolutions, BacksFollowAllFronts) {
  const std::vector<std::uint32_t> first{0, 1, 3};
  const std::vector<Rgb> both{Rgb(1), Rgb(2), Rgb(3), Rgb(4)};
  EXPECT_EQ(on_parts(both, first), (std::vector<Rgb>{Rgb(1), Rgb(2), Rgb(2), Rgb(3), Rgb(4), Rgb(4)}));
}

TEST(CoarserSolutions, NothingStaysNothing) {
  const std::vector<std::uint32_t> first{0, 1, 3};
  EXPECT_TRUE(on_parts({}, first).empty());
}

}  // namespace
}  // namespace fluxel::test

#include "formfactor/share_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "formfactor/pair_rule.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::random_elements;
using test_scenes::uniform;

/// The largest share of any two sides by PairRule::disc.
double share_of(const std::vector<Element>& elements, const PowerEstimate& power, std::size_t i,
                std::size_t j) {
  const double F = pair_form_factor(PairRule::disc, elements[i], elements[j]);
  const double back = F * static_cast<double>(elements[i].area) / static_cast<double>(elements[j].area);
  double most = 0;
  for (std::size_t a = i; a < power.B.size(); a += elements.size())
    for (std::size_t b = j; b < power.B.size(); b += elements.size())
      most = std::max(most, power.share(a, b, F, back));
  return most;
}

TEST(ShareFilter, LeavesOutNothingAboveTheLeastAndLittleElse) {
  std::mt19937 random(1);
  for (const double reach : {1e-15, 1.0, 1e12}) {
    const std::size_t size = 2 * kTileSize + 9;
    const std::vector<Element> elements = random_elements(size, reach, random);
    PowerEstimate power;
    for (std::size_t unknown = 0; unknown < 2 * size; ++unknown) {
      power.B.push_back(1e20 * std::exp(uniform(random, -6, 6)));
      power.H.push_back(1e20 * std::exp(uniform(random, -6, 6)));
    }
    const ShareFilter filter(elements, power);
    std::size_t above = 0, kept = 0;
    for (const double least : {1e-4, 1e-2, 1.0})
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j) {
          if (i == j) continue;
          const bool found = (filter.above(least, i, j / kTileSize) >> j % kTileSize & 1u) != 0;
          const bool wanted = share_of(elements, power, i, j) > least;
          ASSERT_TRUE(found || !wanted) << reach << ' ' << least << ' ' << i << ' ' << j;
          above += wanted ? 1 : 0;
          kept += found ? 1 : 0;
        }
    EXPECT_GT(above, size);
    EXPECT_LT(kept, 5 * above / 2) << "the area of the disc rule and the other sides are all that is more";
  }
}

}  // namespace
}  // namespace fluxel

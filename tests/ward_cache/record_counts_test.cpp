#include "tests/ward_cache/record_counts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "tests/stability/world.hpp"

namespace fluxel::ward_cache {
namespace {

TEST(RecordCounts, AreReadBetweenLogarithms) {
  const std::vector<RecordCount> series{{100, 0.04}, {400, 0.01}};  // records go as the reciprocal error
  EXPECT_NEAR(*records_at(0.02, series), 200, 1e-9);
  EXPECT_FALSE(records_at(0.005, series));
}

/// What records say of each other is less than the error between them (see method/picture_light.cpp).
constexpr double kHidden = 1.25;

/// What is asked of a picture, and what it may take over the records of a lazy cache.
struct Allowed {
  double error, ratio;
};

// The goal is 1.3. Where large errors are allowed it is missed: the first records are there whatever is
// allowed.
TEST(RecordCounts, AreThoseOfALazyCache) {
  const std::string scene = FLUXEL_SOURCE_DIR "/scenes/cornell-box/cornell-box.toml";
  constexpr double kRayError = 1e-4, kFiner = 3;  // a record at each pixel is off by 0.4 %
  GatheredRoom room(test::world(),
                    std::get<SolveRequest>(read_command_line({"solve", scene, "--resolution", "96x96"})),
                    kRayError, kFiner);
  LazyPainter painter(room);
  constexpr std::array kAcceptances{0.8, 0.6, 0.35, 0.2, 0.11};
  std::vector<std::vector<RecordCount>> lazy;
  for (const double least_pixels : {1.0, 5.0})
    lazy.push_back(count_lazily(room, painter, kAcceptances, {0, least_pixels, true}));
  for (const Allowed& allowed : {Allowed{0.005, 1.3}, Allowed{0.04, 2.0}}) {
    const RecordCount found = count_sparsely(room, allowed.error);
    EXPECT_LT(found.error, kHidden * allowed.error);
    double fewest = std::numeric_limits<double>::infinity();
    for (const std::vector<RecordCount>& series : lazy)
      fewest = std::min(fewest, records_at(found.error, series).value_or(fewest));
    ASSERT_LT(fewest, std::numeric_limits<double>::infinity()) << found.error;
    EXPECT_LT(found.records, allowed.ratio * fewest) << allowed.error;
  }
}

}  // namespace
}  // namespace fluxel::ward_cache

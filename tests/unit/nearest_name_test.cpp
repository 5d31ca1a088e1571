#include "core/nearest_name.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fluxel::nearest_name_test {
namespace {

TEST(NearestName, CountsChangesOfLetters) {
  EXPECT_EQ(edit_distance("solve", "solve"), 0u);
  EXPECT_EQ(edit_distance("sovle", "solve"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("slve", "solve"), 1u);
  EXPECT_EQ(edit_distance("soolve", "solve"), 1u);
  EXPECT_EQ(edit_distance("solxe", "solve"), 1u);
  EXPECT_EQ(edit_distance("", "solve"), 5u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u) << "of optimal string alignment";
}

TEST(NearestName, IsOneThatIsNear) {
  const std::vector<std::string> names{"target-error", "tolerance", "eye", "E"};
  EXPECT_EQ(nearest_name("target_error", names), "target-error");
  EXPECT_EQ(nearest_name("targeterorr", names), "target-error");
  EXPECT_EQ(nearest_name("tolerence", names), "tolerance");
  EXPECT_EQ(nearest_name("eey", names), "eye");
  EXPECT_EQ(nearest_name("Kd", names), "") << "two letters are too few to be a mistake of";
  EXPECT_EQ(nearest_name("tol", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("eye", {}), "");
}

TEST(NearestName, OfEquallyNearOnesTheFirst) {
  EXPECT_EQ(nearest_name("wall1", std::vector<std::string>{"wall2", "wall3"}), "wall2");
  EXPECT_EQ(nearest_name("wall33", std::vector<std::string>{"wall2", "wall3"}), "wall3");
}

}  // namespace
}  // namespace fluxel::nearest_name_test

#include "optics/luminaire_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace fluxel::luminaire_tree_test {
namespace {

/// A row of `count`, 1 m apart along x, at z = 2.
std::vector<LuminairePlace> row(int count) {
  std::vector<LuminairePlace> places;
  for (int k = 0; k < count; ++k) places.push_back({{k - 0.1, -0.1, 2}, {k + 0.1, 0.1, 2}, 1.0 + k % 3});
  return places;
}

const LitPlace kFloor{{3, 1, 0}, {0, 0, 1}};

TEST(LuminaireTree, FewAreOneGroup) {
  const LuminaireTree tree(row(8));
  const LuminaireTree::Group group = tree.draw(kFloor, 0.37);
  EXPECT_EQ(group.members.size(), 8u);
  EXPECT_EQ(group.chance, 1);
  EXPECT_EQ(group.choice, 0.37);
  EXPECT_TRUE(LuminaireTree({}).draw(kFloor, 0.5).members.empty());
}

TEST(LuminaireTree, GroupsAreDrawnAsOftenAsTheirChanceSays) {
  const LuminaireTree tree(row(101));
  constexpr int kDraws = 100'000;
  std::map<std::uint32_t, int> times;  // by the first member
  std::map<std::uint32_t, double> chances, choices;
  std::set<std::uint32_t> members;
  std::size_t sizes = 0;
  for (int k = 0; k < kDraws; ++k) {
    const LuminaireTree::Group group = tree.draw(kFloor, (k + 0.5) / kDraws);
    ASSERT_FALSE(group.members.empty());
    ASSERT_LE(group.members.size(), 8u);
    ASSERT_GE(group.choice, 0);
    ASSERT_LT(group.choice, 1);
    const std::uint32_t name = group.members.front();
    if (++times[name] == 1) sizes += group.members.size();
    chances[name] = group.chance;
    choices[name] += group.choice;
    members.insert(group.members.begin(), group.members.end());
  }
  EXPECT_EQ(members.size(), 101u);
  EXPECT_EQ(sizes, 101u) << "each is in one group";
  double sum = 0;
  for (const auto& [name, chance] : chances) {
    sum += chance;
    EXPECT_NEAR(times[name], chance * kDraws, 2) << name;
    EXPECT_NEAR(choices[name] / times[name], 0.5, 1.0 / times[name]) << "what is left of the number is even";
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  const LuminaireTree::Group nearest = tree.draw(kFloor, 0.05);
  EXPECT_LT(nearest.members.front(), 16u) << "near ones are drawn more often than one of thirteen";
}

TEST(LuminaireTree, NoneBelowTheHorizonIsDrawn) {
  const LuminaireTree tree(row(101));
  EXPECT_TRUE(tree.draw({{3, 1, 2.001}, {0, 0, 1}}, 0.5).members.empty());
  for (int k = 0; k < 1000; ++k) {
    const LuminaireTree::Group group = tree.draw({{80.5, 0, 2}, {1, 0, 0}}, k / 1000.0);
    ASSERT_FALSE(group.members.empty());
    std::uint32_t last = 0;
    for (const std::uint32_t member : group.members) last = std::max(last, member);
    EXPECT_GE(last, 80u) << "one of the group is ahead";
  }
}

}  // namespace
}  // namespace fluxel::luminaire_tree_test

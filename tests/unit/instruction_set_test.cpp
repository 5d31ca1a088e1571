#include "visibility/instruction_set.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <set>

#include "core/error.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

struct InstructionSet : testing::Test {
  void TearDown() override { use_instruction_set(Isa::automatic); }
};

/// What decides which of a function's versions is called.
std::size_t chosen_now() { return hwy::GetChosenTarget().GetIndex(); }

TEST_F(InstructionSet, IsTheOneThatWasAskedFor) {
  const std::string best = instruction_set_in_use();
  std::set<std::size_t> chosen;
  for (const Isa isa : supported_instruction_sets()) {
    use_instruction_set(isa);
    chosen.insert(chosen_now());
    EXPECT_EQ(instruction_set_in_use(), name_of(isa));
  }
  EXPECT_EQ(chosen.size(), supported_instruction_sets().size());
  use_instruction_set(Isa::automatic);
  EXPECT_EQ(instruction_set_in_use(), best);
}

TEST_F(InstructionSet, AskingWhichThereAreChangesNothing) {
  const std::vector<Isa> sets = supported_instruction_sets();
  for (const Isa isa : sets) {
    use_instruction_set(isa);
    const std::size_t chosen = chosen_now();
    EXPECT_EQ(supported_instruction_sets(), sets);
    EXPECT_EQ(instruction_set_in_use(), name_of(isa));
    EXPECT_EQ(chosen_now(), chosen);
  }
}

TEST_F(InstructionSet, OneThatIsLackingIsRefusedWithTheBestThereIs) {
  if (supported_instruction_sets().empty()) GTEST_SKIP() << "none to choose from";
  hwy::SetSupportedTargetsForTest(HWY_SSE4 | HWY_STATIC_TARGET);
  EXPECT_EQ(supported_instruction_sets(), std::vector{Isa::sse4});
  EXPECT_NO_THROW(use_instruction_set(Isa::sse4));
  try {
    use_instruction_set(Isa::avx2);
    ADD_FAILURE() << "avx2 is not refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "this processor has no avx2; its best instruction set is sse4");
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Embree only proposes, and what else is vector code has to round alike.
TEST_F(InstructionSet, VisibilityIsTheSameOnAll) {
  const Scene scene = test_scenes::random_plates(59, 0.7, Sides::two, 1);
  const std::vector<Element> elements = test_scenes::uniform_elements(scene, 0.2).elements;
  const auto bits_now = [&] {
    const RayScene ray_scene(scene, 3);  // its limit on threads is the whole program's
    const TileStore store = test_scenes::traced(ray_scene, elements);
    std::vector<TileBits> all;
    for (std::size_t row = 0; row < store.tiles(); ++row)
      for (std::size_t column = row; column < store.tiles(); ++column)
        store.read(row, column, all.emplace_back());
    return all;
  };
  const std::vector<TileBits> best = bits_now();
  for (const Isa isa : supported_instruction_sets()) {
    use_instruction_set(isa);
    EXPECT_EQ(bits_now(), best) << name_of(isa);
  }
}

}  // namespace
}  // namespace fluxel

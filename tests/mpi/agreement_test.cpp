#include "mpi_master/communication/agreement.hpp"
#include "core/input_error_at.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "world.hpp"

namespace fluxel::test {
namespace {

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const AgreedError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Agree, WorksOnEveryRankWhereNobodyFails) {
  std::uint64_t worked = 0;
  EXPECT_NO_THROW(agree(world(), [&] { ++worked; }));
  world().all_sum(std::span(&worked, 1));
  EXPECT_EQ(worked, ranks());
}

TEST(Agree, AllThrowTheMessageOfTheLowestFailingRank) {
  for (int lowest = 0; lowest < world().size(); ++lowest) {
    const auto fail = [&] {
      if (world().rank() >= lowest)
        throw InputError(fmt::format("rank {} {}", world().rank(),
                                     std::string(static_cast<std::size_t>(world().rank()) * 10, '!')));
    };
    EXPECT_EQ(message_of([&] { agree(world(), fail); }),
              fmt::format("rank {} {}", lowest, std::string(static_cast<std::size_t>(lowest) * 10, '!')));
  }
}

TEST(Agree, AMessageMayBeEmpty) {
  EXPECT_EQ(message_of([] { agree(world(), [] { throw InputError(""); }); }), "");
}

TEST(Agree, OtherExceptionsPassAsTheyAre) {
  EXPECT_THROW(agree(world(), [] { throw std::logic_error("a defect"); }), std::logic_error);
  EXPECT_THROW(agree(world(), [] { throw std::bad_alloc(); }), std::bad_alloc);
}

TEST(OnRoot, WorksOnTheRootAlone) {
  std::uint64_t worked = 0;
  EXPECT_NO_THROW(on_root(world(), [&] { ++worked; }));
  EXPECT_EQ(worked, world().is_root() ? 1u : 0u);
}

TEST(OnRoot, AllThrowTheRootsMessage) {
  EXPECT_EQ(message_of([] { on_root(world(), [] { throw input_error_at("a.obj", 7, "bad", "mend it"); }); }),
            "a.obj:7: bad (mend it)");
}

}  // namespace
}  // namespace fluxel::test

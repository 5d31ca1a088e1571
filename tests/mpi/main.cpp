// Runs every test on all ranks. Rank 0 prints; other ranks say what fails on them, and a failure anywhere is
// everybody's.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <optional>

#include "world.hpp"

namespace fluxel::test {

namespace {

/// Set by main before the first test.
std::optional<Communicator> all_ranks;

class RankListener final : public testing::EmptyTestEventListener {
 public:
  [[nodiscard]] std::uint64_t failures() const { return failures_; }

  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (!result.failed()) return;
    ++failures_;
    fatal_ = fatal_ || result.fatally_failed();
    if (world().is_root()) return;  // GoogleTest's own printer has said it
    std::fprintf(stderr, "rank %d: %s:%d: %s\n", world().rank(),
                 result.file_name() ? result.file_name() : "?", result.line_number(), result.message());
  }

  /// A test that was left early, by an assertion or an exception, may have left others waiting for this rank.
  void OnTestEnd(const testing::TestInfo& test) override {
    if (!fatal_) return;
    std::fprintf(stderr, "rank %d left %s early: ending all ranks\n", world().rank(), test.name());
    std::fflush(nullptr);
    world().abort(1);
  }

 private:
  std::uint64_t failures_ = 0;
  bool fatal_ = false;
};

}  // namespace

const Communicator& world() { return *all_ranks; }

}  // namespace fluxel::test

int main(int argc, char** argv) {
  using namespace fluxel;
  const MpiSession session(&argc, &argv);
  test::all_ranks = session.world();
  testing::InitGoogleTest(&argc, argv);
  testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
  if (!session.world().is_root()) delete listeners.Release(listeners.default_result_printer());
  auto* listener = new test::RankListener;
  listeners.Append(listener);

  const int own = RUN_ALL_TESTS();
  std::array<std::uint64_t, 2> sums{listener->failures(), own != 0 ? 1u : 0u};
  session.world().all_sum(sums);
  if (session.world().is_root())
    std::printf("%d ranks: %ju failures, on %ju ranks\n", session.world().size(), std::uintmax_t{sums[0]},
                std::uintmax_t{sums[1]});
  test::all_ranks.reset();
  return sums[1] != 0 ? 1 : 0;
}

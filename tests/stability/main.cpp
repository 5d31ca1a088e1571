// One process without mpirun, since the lab runs what `fluxel solve` runs.

#include <gtest/gtest.h>

#include <optional>

#include "tests/stability/world.hpp"

namespace fluxel::test {

namespace {
/// Set by main before the first test.
std::optional<Communicator> this_process;
}  // namespace

const Communicator& world() { return *this_process; }

}  // namespace fluxel::test

int main(int argc, char** argv) {
  const fluxel::MpiSession session(&argc, &argv);
  fluxel::test::this_process = session.world();
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  fluxel::test::this_process.reset();
  return failed;
}

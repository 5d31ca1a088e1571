#include "core/signals.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace fluxel {
namespace {

void (*handler_of(int signal))(int) {
  struct sigaction action {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler;
}

TEST(Signals, TheFirstOfAKindAsksForAnEndAndTheSecondWouldBeOne) {
  EXPECT_FALSE(end_requested());
  {
    const EndCatcher catcher;
    for (const int signal : {SIGINT, SIGTERM}) {
      EXPECT_NE(handler_of(signal), SIG_DFL);
      std::raise(signal);
      EXPECT_TRUE(end_requested());
      EXPECT_EQ(handler_of(signal), SIG_DFL);
    }
    EXPECT_FALSE(stop_requested()) << "it is no wish to end without a picture";
  }
  { const EndCatcher catcher; }
  for (const int signal : {SIGINT, SIGTERM}) EXPECT_EQ(handler_of(signal), SIG_DFL);
}

}  // namespace
}  // namespace fluxel

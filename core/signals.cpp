#include "core/signals.hpp"

#include <atomic>
#include <csignal>

namespace fluxel {

namespace {

// A handler has nothing else to reach, and may run in any thread.
std::atomic<bool> snapshot_asked{false}, stop_asked{false}, termination{false}, end_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "handlers may use nothing else");

extern "C" void remember(int signal) {
  if (signal == SIGUSR1) snapshot_asked = true;
  if (signal == SIGTERM) termination = true;
  if (signal != SIGUSR1) stop_asked = true;
}

extern "C" void remember_end(int /*signal*/) { end_asked = true; }

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void catch_user_signals() {
  handle(SIGUSR1, remember, 0);
  handle(SIGUSR2, remember, 0);
}

void release_user_signals() {
  handle(SIGUSR1, SIG_DFL, 0);
  handle(SIGUSR2, SIG_DFL, 0);
}

bool take_snapshot_request() { return snapshot_asked.exchange(false); }

bool stop_requested() { return stop_asked; }

void request_stop() { stop_asked = true; }

TerminationCatcher::TerminationCatcher() { handle(SIGTERM, remember, static_cast<int>(SA_RESETHAND)); }

TerminationCatcher::~TerminationCatcher() { handle(SIGTERM, SIG_DFL, 0); }

bool TerminationCatcher::take_termination() { return termination.exchange(false); }

bool end_requested() { return end_asked; }

EndCatcher::EndCatcher() {
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, remember_end, static_cast<int>(SA_RESETHAND));
}

EndCatcher::~EndCatcher() {
  for (const int signal : {SIGINT, SIGTERM}) handle(signal, SIG_DFL, 0);
}

}  // namespace fluxel

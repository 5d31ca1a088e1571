#pragma once

namespace fluxel {

/// From now on SIGUSR1 and SIGUSR2 end nothing: they are remembered until somebody asks. To be called once,
/// before any other thread is started.
void catch_user_signals();

/// As before: they end the process.
void release_user_signals();

/// Whether SIGUSR1, show or keep what there is and go on, has come since this was last asked.
[[nodiscard]] bool take_snapshot_request();

/// Whether SIGUSR2, write a checkpoint and stop, or a caught SIGTERM has come.
[[nodiscard]] bool stop_requested();

/// As SIGUSR2 here: another process of this host has had one.
void request_stop();

/// While it lives one SIGTERM, which launchers and schedulers send shortly before they kill, is remembered
/// too; a second one, or one at any other time, ends the process at once.
class TerminationCatcher {
 public:
  TerminationCatcher();
  ~TerminationCatcher();
  TerminationCatcher(const TerminationCatcher&) = delete;
  TerminationCatcher& operator=(const TerminationCatcher&) = delete;

  /// Whether it has come since this was last asked.
  [[nodiscard]] static bool take_termination();
};

/// Whether SIGINT or SIGTERM, end with what there is, has come while an EndCatcher lived.
[[nodiscard]] bool end_requested();

/// While it lives the first SIGINT and the first SIGTERM ask for an end; a second one of the same kind, or
/// one at any other time, ends the process at once.
class EndCatcher {
 public:
  EndCatcher();
  ~EndCatcher();
  EndCatcher(const EndCatcher&) = delete;
  EndCatcher& operator=(const EndCatcher&) = delete;
};

}  // namespace fluxel

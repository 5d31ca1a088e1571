#pragma once

#include <cstdint>
#include <vector>

namespace fluxel {

/// What a rank does with its time while work is assigned.
enum class ActivityKind : std::uint8_t { compute, messages, wait };

/// A stretch of it [s since all ranks began].
struct ActivitySpan {
  int rank = 0;
  ActivityKind kind = ActivityKind::compute;
  double start = 0, end = 0;
};

/// A rank's part in a job that is scheduled.
struct Activity {
  double busy_seconds = 0, message_seconds = 0, waiting_seconds = 0;
  std::uint64_t strips = 0, tiles = 0;  ///< computed
  std::uint64_t messages_sent = 0, bytes_sent = 0;
};

}  // namespace fluxel

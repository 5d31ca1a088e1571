#include "mpi_master/scheduling/schedule_progress.hpp"

#include <algorithm>
#include <span>

namespace fluxel {

void ScheduleProgress::assign(int rank, double cost, double seconds) {
  Part& part = parts_[static_cast<std::size_t>(rank)];
  part.finished += part.current;
  part.current = cost;
  part.since = seconds;
}

double ScheduleProgress::done_by_others(double seconds) const {
  double done = 0;
  for (const Part& part : std::span(parts_).subspan(1)) {
    const double pace = part.finished > 0 ? part.finished / part.since : 0;
    done += part.finished + std::min(part.current, pace * (seconds - part.since));
  }
  return done;
}

}  // namespace fluxel

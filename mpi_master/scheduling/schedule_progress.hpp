#pragma once

#include <vector>

namespace fluxel {

/// How much of the work that rank 0 has assigned is done, in the unit of its predicted cost. Rank 0 knows its
/// own part; of another rank's last strip nobody reports anything until the rank asks for the next one, so
/// it goes by the rank's pace until now.
class ScheduleProgress {
 public:
  explicit ScheduleProgress(int ranks) : parts_(static_cast<std::size_t>(ranks)) {}

  /// The rank is about to be done with what it was assigned before, and gets a strip of this cost, 0 for
  /// none.
  void assign(int rank, double cost, double seconds);

  /// Of all ranks but rank 0.
  [[nodiscard]] double done_by_others(double seconds) const;

 private:
  struct Part {
    double finished = 0, current = 0;  // cost
    double since = 0;                  // when the current strip began [s]
  };

  std::vector<Part> parts_;
};

}  // namespace fluxel

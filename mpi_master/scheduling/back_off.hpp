#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace fluxel {

/// Sleeps between looks at something that another rank will do, so that waiting takes no processor time from
/// ranks that compute: a tenth of what has been waited already, so that it adds a tenth at most to long waits
/// and microseconds to short ones.
class BackOff {
 public:
  explicit BackOff(std::chrono::microseconds longest = std::chrono::microseconds(500)) : longest_(longest) {}

  /// Something has come: the next wait begins anew.
  void reset() { waited_ = {}; }

  void wait() {
    using std::chrono::microseconds;
    const auto pause = std::clamp<microseconds>(waited_ / 10, microseconds(20), longest_);
    const auto start = Clock::now();
    std::this_thread::sleep_for(pause);
    waited_ += std::chrono::duration_cast<microseconds>(Clock::now() - start);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::microseconds longest_, waited_{};
};

}  // namespace fluxel

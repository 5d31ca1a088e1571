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
  /// Something has come: the next wait begins anew.
  void reset() { waited_ = {}; }

  void wait() {
    using std::chrono::microseconds;
    const auto pause = std::clamp<microseconds>(waited_ / 10, microseconds(20), microseconds(500));
    const auto start = Clock::now();
    std::this_thread::sleep_for(pause);
    waited_ += std::chrono::duration_cast<microseconds>(Clock::now() - start);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::microseconds waited_{};
};

}  // namespace fluxel

#include "mpi_master/steps/incoming_corrections.hpp"

#include <cstdint>

namespace fluxel {

namespace {

/// What is found between two questions, and under way between ranks meanwhile [bytes].
constexpr std::uint64_t kUnderWay = std::uint64_t{16} << 20;

}  // namespace

bool IncomingCorrections::has_room() {
  if (size() < ask_at_) return true;
  const std::uint64_t available = available_();
  const std::uint64_t spoken_for = kUnderWay + size() * kCorrectionBytes;
  if (available <= spoken_for) return false;
  ask_at_ = size() + (available - spoken_for) / (2 * kFoundCorrectionBytes) + 1;
  return true;
}

}  // namespace fluxel

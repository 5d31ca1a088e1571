// The bytes of a tally of photons; once more with the check sums set right, so that what lies behind them is
// reached.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>

#include "core/hash.hpp"
#include "photons/photon_estimates.hpp"
#include "photons/tally_file.hpp"

namespace {

constexpr std::size_t kHeader = 64;

void put(std::string& bytes, std::size_t at, std::uint64_t number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

std::uint64_t hash_of(const std::string& bytes, std::size_t first, std::size_t count) {
  return fluxel::hash_bytes(std::as_bytes(std::span(bytes)).subspan(first, count));
}

void read(const std::string& bytes) {
  const fluxel::TallyShape shape{2, 3, {2}, true};
  const auto result = fluxel::read_tally_file(std::as_bytes(std::span(bytes)), {0x1234, {}}, shape);
  if (result.tally.has_value() != result.defect.empty()) std::abort();
  if (!result.tally) return;
  const double areas[] = {1, 0, 2};
  if (fluxel::irradiance_estimates(*result.tally, {0, areas, false}, 1).size() != 3) std::abort();
  static_cast<void>(fluxel::irradiance_errors(*result.tally, {3, std::span(areas).first(2), true}, 1));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  read(bytes);
  if (size < kHeader) return 0;
  bytes.replace(0, 8, "FLXTALLY");
  put(bytes, 8, 1);  // version 1, Sequence::sobol
  put(bytes, 16, 0x1234);
  put(bytes, 24, 0);
  put(bytes, 40, (size - kHeader) / 8);
  put(bytes, 48, hash_of(bytes, kHeader, size - kHeader));
  put(bytes, 56, hash_of(bytes, 0, 56));
  read(bytes);
  return 0;
}

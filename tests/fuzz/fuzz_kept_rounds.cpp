// The bytes of both files that keep a round of a hierarchy; once more with the check sums set right, so that
// what lies behind them is reached.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <sstream>
#include <string>

#include "core/hash.hpp"
#include "hierarchy/kept_rounds.hpp"
#include "hierarchy/link_file.hpp"

namespace {

constexpr std::uint64_t kIdentity = 0x1234;
constexpr std::size_t kNodes = 100;

void put(std::string& bytes, std::size_t at, std::uint64_t number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

std::uint64_t hash_from(const std::string& bytes, std::size_t first, std::size_t count,
                        std::uint64_t seed = 0) {
  return fluxel::hash_bytes(std::as_bytes(std::span(bytes)).subspan(first, count), seed);
}

void read_rounds(const std::string& bytes) {
  const auto result = fluxel::read_rounds_file(std::as_bytes(std::span(bytes)), kIdentity);
  if (result.kept.has_value() != result.defect.empty()) std::abort();
  if (result.kept &&
      (result.kept->rounds.empty() || result.kept->radiosity.B.size() != result.kept->radiosity.H.size()))
    std::abort();
}

void read_links(const std::string& bytes) {
  std::istringstream stream(bytes, std::ios::binary);
  const auto result =
      fluxel::read_link_file(stream, {kIdentity, 3}, kNodes, [](std::uint64_t) { return true; });
  for (const fluxel::Link& link : result.links)
    if (link.p >= kNodes || link.q >= kNodes) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  read_rounds(bytes);
  read_links(bytes);

  if (size >= 48) {
    put(bytes, 16, kIdentity);
    put(bytes, 24, size - 48);
    put(bytes, 32, hash_from(bytes, 48, size - 48));
    put(bytes, 40, hash_from(bytes, 0, 40));
    read_rounds(bytes);
  }
  if (size >= 80) {
    bytes.assign(reinterpret_cast<const char*>(data), size);
    put(bytes, 16, kIdentity);
    put(bytes, 24, 3);
    put(bytes, 72, hash_from(bytes, 0, 72));
    if (size >= 88) put(bytes, size - 8, hash_from(bytes, 80, size - 88, hash_from(bytes, 0, 72)));
    read_links(bytes);
  }
  return 0;
}

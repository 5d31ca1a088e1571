#include "bench/gpu_check/correctness.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <mutex>

#include "bench/gpu_check/brute_force.hpp"
#include "bench/gpu_check/distances.hpp"
#include "bench/gpu_check/tiles.hpp"
#include "visibility/cuda/host_trace.hpp"

namespace fluxel::cuda::checks {

namespace {

constexpr std::uint64_t kMaxPrinted = 10;  // of a comparison's differences

/// Sums what threads find.
class Findings {
 public:
  Findings(const CheckedScene& checked, const char* against) : scene_(checked.arrays.view()) {
    sum_.scene = checked.scene.name;
    sum_.against = against;
    sum_.elements = checked.elements;
  }

  void add_pairs(std::uint64_t pairs, std::uint64_t facing, std::uint64_t visible) {
    const std::lock_guard lock(mutex_);
    sum_.pairs += pairs;
    sum_.facing += facing;
    sum_.visible += visible;
  }

  void add_difference(std::uint32_t row, std::uint32_t column, bool expected) {
    const std::lock_guard lock(mutex_);
    if (sum_.differing++ >= kMaxPrinted) return;
    const NearMiss near = near_miss(scene_, scene_.ends[row], scene_.ends[column]);
    std::printf(
        "  %s, %s: elements %" PRIu32 " and %" PRIu32
        " should %ssee each other; from the ray to the nearest edge %.3g m, from its ends to the nearest "
        "patch %.3g m\n",
        sum_.scene.c_str(), sum_.against.c_str(), row, column, expected ? "" : "not ", near.edge, near.end);
  }

  void add_wrong_count(const TilePlace& place, const TileResult& expected, const TileResult& found) {
    const std::lock_guard lock(mutex_);
    if (sum_.differing++ >= kMaxPrinted) return;
    std::printf("  %s, %s: in tile (%" PRIu32 ", %" PRIu32 ") %" PRIu32 " pairs face each other and %" PRIu32
                " are tested, but should %" PRIu32 " and %" PRIu32 "\n",
                sum_.scene.c_str(), sum_.against.c_str(), place.row, place.column, found.facing, found.tested,
                expected.facing, expected.tested);
  }

  [[nodiscard]] const Comparison& sum() const { return sum_; }

 private:
  const TileScene scene_;
  Comparison sum_;
  std::mutex mutex_;
};

void compare_tiles(const TilePlace& place, const TileResult& expected, const TileResult& found,
                   Findings& findings) {
  if (expected.facing != found.facing || expected.tested != found.tested)
    findings.add_wrong_count(place, expected, found);
  std::uint64_t visible = 0;
  for (std::uint32_t r = 0; r < kTile; ++r) {
    for (std::uint32_t c = 0; c < kTile; ++c) {
      visible += sees(expected, r, c) ? 1 : 0;
      if (sees(expected, r, c) != sees(found, r, c))
        findings.add_difference(place.row * kTile + r, place.column * kTile + c, sees(expected, r, c));
    }
  }
  findings.add_pairs(std::uint64_t{kTile} * kTile, expected.facing, visible);
}

}  // namespace

Comparison compare_with_brute_force(const CheckedScene& checked, double segment_tests, unsigned threads) {
  const TileScene scene = checked.arrays.view();
  const auto rows = static_cast<std::size_t>(std::max(16.0, segment_tests / kTile / scene.patches));
  const std::vector<TilePlace> places = spread_tiles(scene.tiles, std::max<std::size_t>(16, rows / kTile));
  const auto rows_of_tile =
      static_cast<std::uint32_t>(std::clamp<std::size_t>(rows / places.size(), 1, kTile));
  Findings findings(checked, "brute force");
  in_parallel(places.size(), threads, [&](std::size_t number) {
    const TilePlace& place = places[number];
    const TileResult found = trace_on_host(scene, place);
    std::uint64_t visible = 0;
    for (std::uint32_t k = 0; k < rows_of_tile; ++k) {
      // Without a common divisor, so that rows of all groups come along.
      const std::uint32_t r = (static_cast<std::uint32_t>(number) + 37 * k) % kTile;
      for (std::uint32_t c = 0; c < kTile; ++c) {
        const std::uint32_t row = place.row * kTile + r, column = place.column * kTile + c;
        const bool expected = column > row && sees_by_brute_force(scene, scene.ends[row], scene.ends[column]);
        visible += expected ? 1 : 0;
        if (sees(found, r, c) != expected) findings.add_difference(row, column, expected);
      }
    }
    findings.add_pairs(std::uint64_t{rows_of_tile} * kTile, found.facing, visible);
  });
  return findings.sum();
}

Comparison compare_with_nothing_seen(const CheckedScene& checked, std::size_t tiles, unsigned threads) {
  const TileScene scene = checked.arrays.view();
  const std::vector<TilePlace> places = spread_tiles(scene.tiles, tiles);
  Findings findings(checked, "what is known");
  in_parallel(places.size(), threads, [&](std::size_t number) {
    const TileResult found = trace_on_host(scene, places[number]);
    TileResult nothing{};
    nothing.facing = found.facing;
    nothing.tested = found.tested;
    compare_tiles(places[number], nothing, found, findings);
  });
  return findings.sum();
}

Comparison compare_with_device(const CheckedScene& checked, DeviceTracer& tracer, std::size_t tiles,
                               unsigned threads) {
  const TileScene scene = checked.arrays.view();
  const std::vector<TilePlace> places = spread_tiles(scene.tiles, tiles);
  Findings findings(checked, "device");
  tracer.trace(places, [&](std::size_t first, const TileResult* results, std::size_t count) {
    in_parallel(count, threads, [&](std::size_t k) {
      const TilePlace& place = places[first + k];
      compare_tiles(place, trace_on_host(scene, place), results[k], findings);
    });
  });
  return findings.sum();
}

}  // namespace fluxel::cuda::checks

#include "bench/solver/fma_peak.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/solver/fma_peak.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include <hwy/highway.h>

#include <array>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace fluxel::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Runs chains of `steps` steps; returns how many multiply-adds that were, and a value that needs them all.
std::size_t run_chains(std::size_t steps, float& value) {
  constexpr std::size_t kChains = 12;
  const hn::ScalableTag<float> d;
  std::array<hn::Vec<hn::ScalableTag<float>>, kChains> chains;
  for (std::size_t k = 0; k < kChains; ++k) chains[k] = hn::Set(d, static_cast<float>(k));
  const auto factor = hn::Set(d, 0.999f), summand = hn::Set(d, 0.001f);
  for (std::size_t step = 0; step < steps; ++step)
    for (std::size_t k = 0; k < kChains; ++k) chains[k] = hn::MulAdd(chains[k], factor, summand);
  auto sum = hn::Zero(d);
  for (std::size_t k = 0; k < kChains; ++k) sum = hn::Add(sum, chains[k]);
  value = hn::GetLane(sum);
  return steps * kChains * hn::Lanes(d);
}

}  // namespace fluxel::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "bench/visibility/stopwatch.hpp"

namespace fluxel::bench {

HWY_EXPORT(run_chains);

double fma_peak() {
  constexpr std::size_t kSteps = 1'000'000;
  std::size_t count = 0;
  volatile float keep = 0;
  const double seconds = thread_seconds_of([&] {
    float value = 0;
    count = HWY_DYNAMIC_DISPATCH(run_chains)(kSteps, value);
    keep = value;
  });
  return static_cast<double>(count) / seconds;
}

}  // namespace fluxel::bench

#endif  // HWY_ONCE

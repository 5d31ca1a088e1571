#include "visibility/instruction_set.hpp"

#include <fmt/format.h>
#include <hwy/targets.h>

#include <array>
#include <cstdint>

#include "core/error.hpp"

namespace fluxel {

namespace {

struct NamedSet {
  Isa isa;
  const char* name;
  std::int64_t target;  // Highway's bit, the better the lower
};

constexpr std::array<NamedSet, 3> kSets{
    {{Isa::avx512, "avx512", HWY_AVX3}, {Isa::avx2, "avx2", HWY_AVX2}, {Isa::sse4, "sse4", HWY_SSE4}}};

/// Highway 1.0 takes the best target of the processor again whenever it is asked what is supported, whatever
/// has been disabled; so the answer is made its choice at once, before any thread can take another.
std::int64_t usable_targets() {
  const std::int64_t supported = hwy::SupportedTargets();
  hwy::GetChosenTarget().Update(supported);
  return supported & HWY_TARGETS;
}

std::int64_t best_target() {
  const std::int64_t usable = usable_targets();
  return usable & -usable;
}

/// Leaves this target and those poorer.
void limit_targets(std::int64_t best) {
  hwy::DisableTargets(best - 1);
  usable_targets();
}

}  // namespace

const char* name_of(Isa isa) {
  for (const NamedSet& set : kSets)
    if (set.isa == isa) return set.name;
  return "auto";
}

std::vector<Isa> supported_instruction_sets() {
  const std::int64_t in_use = best_target();
  hwy::DisableTargets(0);
  const std::int64_t best = best_target();
  limit_targets(in_use);
  std::vector<Isa> sets;
  for (const NamedSet& set : kSets)
    if (set.target >= best) sets.push_back(set.isa);
  return sets;
}

void use_instruction_set(Isa isa) {
  hwy::DisableTargets(0);
  for (const NamedSet& set : kSets) {
    if (set.isa != isa) continue;
    if ((usable_targets() & set.target) == 0)
      throw InputError(fmt::format("this processor has no {}; its best instruction set is {}", set.name,
                                   instruction_set_in_use()));
    limit_targets(set.target);
  }
}

std::string instruction_set_in_use() {
  const std::int64_t in_use = best_target();
  for (const NamedSet& set : kSets)
    if (set.target == in_use) return set.name;
  return hwy::TargetName(in_use);
}

}  // namespace fluxel

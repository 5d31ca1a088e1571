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

std::int64_t usable_targets() { return hwy::SupportedTargets() & HWY_TARGETS; }
std::int64_t best_target() { return usable_targets() & -usable_targets(); }

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
  hwy::DisableTargets(in_use - 1);
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
    hwy::DisableTargets(set.target - 1);
  }
}

std::string instruction_set_in_use() {
  const std::int64_t in_use = best_target();
  for (const NamedSet& set : kSets)
    if (set.target == in_use) return set.name;
  return hwy::TargetName(in_use);
}

}  // namespace fluxel

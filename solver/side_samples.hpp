#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/escape_fraction.hpp"

#include "solver/unknowns.hpp"

namespace fluxel {

/// So many sides tell where the power of all goes; where there are no more, all of them do.
inline constexpr std::size_t kSampledSides = 8192;

/// A side that rays are sent from for many.
struct SideSample {
  std::uint32_t unknown = 0;
  /// How often it was drawn over how often that had to be expected: what a sum over samples counts it with.
  /// 1 where all sides are there.
  double weight = 1;
  std::uint32_t draws = 1;
  SideView view = {};
};

/// Sides with rays still to come: all that are unknowns, or kSampledSides draws by area and by reflected and
/// emitted power, one half each, at even distances along their sums (systematic sampling: Madow & Madow
/// 1944).
[[nodiscard]] std::vector<SideSample> choose_sides(const Unknowns& unknowns, std::span<const Rgb> B);

/// No ray of a sample escapes.
[[nodiscard]] bool is_closed(std::span<const SideSample> samples);

/// Of all sides, as closure_defect_rms has it of each.
[[nodiscard]] double closure_defect_rms(const Unknowns& unknowns, std::span<const double> row_sums,
                                        std::span<const SideSample> samples);

/// What `views` has of all unknowns, an entry each.
[[nodiscard]] std::vector<SideSample> all_sides(const Unknowns& unknowns, std::span<const SideView> views);

}  // namespace fluxel

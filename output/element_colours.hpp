#pragma once

#include <cstdint>
#include <vector>

#include "output/output_table.hpp"

namespace fluxel {

/// How a run's elements are shown: as its picture is, without one by the light of the elements themselves.
[[nodiscard]] ToneCurve curve_of_elements(const OutputSource& source);

/// A colour of each element, three values, sRGB: of its front, of what has no unknown front of its back.
[[nodiscard]] std::vector<std::uint8_t> colours_of_elements(const OutputSource& source);

}  // namespace fluxel

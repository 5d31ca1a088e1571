#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fluxel {

/// sRGB colours, three bytes a value, of signed values: blue at -range and below, near white at 0, red at
/// range and above (ColorBrewer's RdBu: Harrower & Brewer, The Cartographic Journal 40, 2003; kept apart also
/// by those who do not tell red from green).
[[nodiscard]] std::vector<std::uint8_t> diverging_colours(std::span<const double> values, double range);

}  // namespace fluxel

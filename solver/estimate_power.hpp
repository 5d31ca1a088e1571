#pragma once

#include <span>

#include "formfactor/power_estimate.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// The radiosity after one bounce of the emitted light plus an ambient term: what has been reflected more
/// often is taken as evenly spread. One application of F; an entry an unknown of this rank.
[[nodiscard]] PowerEstimate estimate_power(RadiosityOperator& F, const Unknowns& unknowns);

/// By about what B and H [W/m2] are; an entry an unknown of this rank. By all ranks together.
[[nodiscard]] PowerEstimate power_of_light(const Ranks& ranks, std::span<const Rgb> B,
                                           std::span<const Rgb> H);

/// The same of a whole scene without any form factor: all light is taken as evenly spread.
[[nodiscard]] PowerEstimate even_power(const Unknowns& unknowns);

}  // namespace fluxel

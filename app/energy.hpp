#pragma once

#include <span>
#include <vector>

#include "formfactor/open_fraction.hpp"
#include "solver/iterate.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// Where the emitted power goes [W], for each colour. Escaped power comes from rays of its own, not from what
/// is missing in the row sums, so that the defect measures the form factors.
struct EnergyBalance {
  Rgb emitted{0};
  Rgb absorbed{0};  ///< by the unknown sides
  Rgb escaped{0};
  Rgb dark{0};            ///< that ends on sides which are no unknowns
  Rgb defect{0};          ///< emitted - absorbed - escaped - dark
  Rgb sampling_error{0};  ///< standard error of escaped + dark
};

[[nodiscard]] EnergyBalance energy_balance(const Unknowns& unknowns, const Radiosity& radiosity,
                                           std::span<const SideView> views);

}  // namespace fluxel

#pragma once

#include <span>
#include <vector>

#include "optics/luminaire_escape.hpp"
#include "solver/iterate.hpp"
#include "solver/side_samples.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// Where the emitted power goes [W], of surfaces and luminaires, for each colour. Escaped power comes from
/// rays of its own, not from what is missing in the row sums, so that the defect measures the form factors.
struct EnergyBalance {
  Rgb emitted{0};
  Rgb received{0};   ///< by the unknown sides, absorbed or not
  Rgb absorbed{0};   ///< by the unknown sides; heat that a prescribed flux draws (E < 0) included
  Rgb convected{0};  ///< heat that the air takes from faces; what it gives to faces is emitted
  Rgb escaped{0};
  Rgb dark{0};            ///< that ends on sides which are no unknowns
  Rgb defect{0};          ///< emitted - absorbed - convected - escaped - dark
  Rgb sampling_error{0};  ///< standard error of escaped + dark
};

/// Of the colours that are emitted, over the emitted power; not a number where any of them is none.
[[nodiscard]] double largest_relative_defect(const EnergyBalance& balance);

/// The same, beyond a tenth of the emitted power and three standard errors of the rays: more than form
/// factors of elements that are small enough leave.
[[nodiscard]] bool is_large_defect(const EnergyBalance& balance);

/// Whether the unknown sides receive less than a hundredth of the emitted power.
[[nodiscard]] bool nearly_all_escapes(const EnergyBalance& balance);

/// `samples`: as choose_sides has them, with their views.
[[nodiscard]] EnergyBalance energy_balance(const Unknowns& unknowns, const Radiosity& radiosity,
                                           std::span<const SideSample> samples,
                                           const LuminaireEscape& luminaires);

}  // namespace fluxel

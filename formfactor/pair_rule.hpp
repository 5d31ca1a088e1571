#pragma once

#include "core/element.hpp"
#include "core/options.hpp"

namespace fluxel {

/// The form factor F_ij of two elements that see each other, in double precision: the plain statement of what
/// the solver's vector kernel computes. With r the distance of the centroids and c the cosines:
///
///   point  F_ij = A_j c_i c_j / (pi r^2)                   (Debelov & Sattarov, eq. 6, with its 1/pi)
///   disc   F_ij = A_j c_i c_j / (pi r^2 + max(A_i, A_j))   (Wallace, Elmquist & Haines 1989, eq. 6)
///
/// Eq. 6 as printed in the first source lacks the 1/pi. In the second the source's area became the larger of
/// both, so that A_i F_ij = A_j F_ji stays exact; both F are then at most 1. The cosines count by magnitude:
/// which sides face each other is the visibility's knowledge.
[[nodiscard]] double pair_form_factor(FormFactor rule, const Element& i, const Element& j);

}  // namespace fluxel

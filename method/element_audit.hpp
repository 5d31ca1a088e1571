#pragma once

#include <span>

#include "method/audit.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// The light of elements as an audit looks at it.
struct AuditedElements {
  std::span<const Rgb> H;                   ///< irradiance of the unknowns [W/m2], on all ranks
  IrradianceSource* gathered_by = nullptr;  ///< the picture's; null: the picture shows the elements
};

/// Collective: measures how far the picture or the surfaces are off, as they are shown, into the solution; a
/// signal ends it. The raster need not be on other ranks than the root.
void audit_elements(const Problem& problem, const AuditedElements& elements, AuditGoal goal,
                    Solution& solution);

}  // namespace fluxel

#pragma once

#include <span>
#include <vector>

#include "hierarchy/irradiance_source.hpp"
#include "method/audit.hpp"

namespace fluxel {

/// The places of an audit as points of the tree's faces.
[[nodiscard]] std::vector<GatherPoint> points_of(const NodeTree& tree, const AuditSubject& subject);

/// Collective: what a solution reflects at an audit's places, which these points are, by rays of this error:
/// without what the places emit.
[[nodiscard]] StatedLight reflected_at(IrradianceSource& source, std::span<const GatherPoint> points,
                                       const AuditSubject& subject, double ray_error);

/// What the places emit is added.
void add_emission(const AuditSubject& subject, StatedLight& stated);

}  // namespace fluxel

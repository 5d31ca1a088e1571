#pragma once

#include <vector>

#include "core/ids.hpp"
#include "scene/polygon.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Two patches of one plane that share area: the winner covers the loser there.
struct Overlap {
  PatchId winner{};
  PatchId loser{};
  /// By which one lies in front of the other, where that is more than rounding and one emits or another
  /// material shows [m]; else 0.
  double gap = 0;
};

/// A patch touched or crossed inside its area by another, along a segment in its plane; or the edge of what
/// hovers just above it, projected onto it.
struct Contact {
  PatchId touched{};
  PatchId by{};
  Segment segment;
  double length = 0;  ///< [m]
  double gap = 0;     ///< largest distance of the edge from the plane; 0 where they touch [m]
};

/// Two one-sided patches of one plane that share area and face opposite ways: each other's fronts, as a box
/// and the floor below it, or neither, as the walls of two rooms.
struct Facing {
  PatchId first{}, second{};  ///< ascending
};

struct ContactPairs {
  std::vector<Overlap> overlaps;  ///< ordered by winner, emitters first, then by loser
  std::vector<Facing> facing;     ///< ordered
  /// Ordered by touched patch, those that touch before those across a gap, then longest first, then by the
  /// other patch.
  std::vector<Contact> contacts;
};

/// What nearer than this counts as touching: 1e-6 of the diagonal of the patches' box [m].
[[nodiscard]] double contact_tolerance(const Scene& scene);

/// Finds the pairs by a tree of boxes (R-tree, packed: Leutenegger, Lopez & Edgington 1997).
///
/// Patches are of one plane where one of them lies within `tolerance` of the other's plane. Of such a pair
/// that shares area the emitter wins, then the lower patch number: the rule by which a ray that hits both
/// chooses. Where one of two that differ lies by more than a tenth of the tolerance in front of what the
/// other sends, it covers that and wins. Two one-sided patches with opposite normals are the two faces of one
/// sheet, or a box on a floor: no ray from a used side meets both fronts, so neither covers the other; their
/// outlines are contacts.
///
/// A contact along the touched patch's own outline (mesh neighbours, edges of a box) is none. Without
/// `with_contacts` only overlaps are found.
///
/// An edge of a patch no farther from a used side of another than an eighth of the first one's width casts a
/// shadow edge straight behind it, for hardly any light gets into the gap: its projection is a contact.
/// The same for every number of threads.
[[nodiscard]] ContactPairs find_contact_pairs(const Scene& scene, double tolerance, bool with_contacts,
                                              int threads);

}  // namespace fluxel

#pragma once

#include "scene/patch_mesh.hpp"
#include "scene/scene.hpp"

namespace fluxel {

class Progress;

/// Fills the scene's pieces, in the order of the patches, with statistics and notes.
///
/// Area that another patch of the same plane covers is taken from the covered patch (see contact_pairs.hpp
/// for who wins); where closed bodies touch one another or a one-sided surface, what touches is taken from
/// both: it sees nothing. Then, with `cut_contacts`, patches are cut where others touch or cross them inside
/// their area, so that no element lies on both sides of another patch (Baum, Mann, Smith & Winget 1991,
/// "Making radiosity usable"): longest contact first, each across the convex parts whose inside it crosses by
/// more than 1e-6 of the scene's diagonal. Points are never moved: the areas of a patch's pieces add up to
/// its area less what is covered. The outline of a patch that is left whole is its piece, to the last bit. A
/// part no wider than twice the tolerance is not cut off: so near to a patch rays do not tell its two sides
/// apart. For the same reason two-sided patches that emit nothing and are no wider get no piece: they stay
/// occluders.
///
/// Where n patches all cross one another, parts grow as the cube of n. Throws InputError that names what is
/// crossed most where there are more than 500,000 parts, more than 32 a patch, and more than 2 a contact.
/// `progress`, of a phase that has begun, receives how far cutting is.
void cut_patches(Scene& scene, const PatchMesh& mesh, bool cut_contacts, int threads = 1,
                 Progress* progress = nullptr);

}  // namespace fluxel

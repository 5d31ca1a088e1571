#pragma once

#include <filesystem>
#include <string>

#include "scene/readers/mtl_check.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// An OBJ file and its material files after the check: only the statements that Fluxel uses, each on one
/// line, numbers in their shortest form, indices positive and in range. A parser can no longer meet a bad
/// value.
struct CheckedObj {
  /// `v`, `f` (vertex indices alone), `usemtl`, and `o` for both groups and objects. Where a material has
  /// maps also `vt`, and `f` of such materials with its indices (vertex/vt, of those corners that have one).
  std::string geometry;
  CheckedMaterials materials;  ///< of all material files; its notes are of the geometry as well
};

/// Checks the text of an OBJ file, and of the material files that it names, by the format as Wavefront's
/// Advanced Visualizer manual (1990, appendix B1) has it. Statements that say nothing of surfaces or
/// materials are left out. `file` stands in messages and is where relative names of material files start.
/// Throws InputError with file and line.
[[nodiscard]] CheckedObj check_obj_text(const std::filesystem::path& file, const std::string& text,
                                        const TextLookup& lookup);

}  // namespace fluxel

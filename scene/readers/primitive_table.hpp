#pragma once

#include "scene/readers/toml_file.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Whether a table [[geometry]] gives a shape in place of a file.
[[nodiscard]] bool names_primitive(const toml::table& table);

/// The shape of a table [[geometry]], before it is placed: `box = [a, b, c]` reaches from the origin to (a,
/// b, c), its fronts outwards, or with `inwards = true` inwards, as a room's; `rectangle = [a, b]` lies in
/// the plane z = 0, its front towards +z. Groups are named after `group`, those of a box with the side, as in
/// `box +z`. Materials are those of `material` and, for single sides, `material_of`; they have a reflectance
/// of 0.5. Throws InputError with file and line. The keys of placing are left to the caller.
[[nodiscard]] SceneInput read_primitive(const TomlFile& toml, const toml::table& table);

}  // namespace fluxel

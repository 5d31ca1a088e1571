#pragma once

#include <string>

#include "scene/readers/toml_file.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// What a table [materials.NAME] of a scene file, which errors call `where`, says of SurfaceOptics, into a
/// material that has the table's rho and E already. Throws InputError with file and line: a share outside
/// 0..1, shares that add up to more than 1 with the reflectance, an index of refraction below 1 or beside
/// anything else.
void read_optics(const TomlFile& toml, const toml::table& table, const std::string& where,
                 InputMaterial& material);

}  // namespace fluxel

#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/readers/texture_map.hpp"

namespace fluxel {

/// Where something stands.
struct Place {
  std::filesystem::path file;
  std::size_t line = 0;
};

/// The images of a material, by which its values are multiplied.
struct MaterialMaps {
  std::optional<TextureMap> Kd, Ke;
  bool has_Kd = false;  ///< the material has a Kd
};

/// What is used of material files after the check: a parser can no longer meet a bad value.
struct CheckedMaterials {
  std::string text;                          ///< `newmtl`, `Kd`, `Ke` and kHeatNames, each name once
  std::map<std::string, Place> places;       ///< of each material's newmtl
  std::map<std::string, MaterialMaps> maps;  ///< of the materials that have any
  std::vector<std::string> notes;
};

/// Checks the text of a material file and adds what it says. `file` stands in messages, and its folder is
/// where relative names of images start. Throws InputError with file and line.
void check_mtl_text(const std::filesystem::path& file, const std::string& text, CheckedMaterials& materials);

}  // namespace fluxel

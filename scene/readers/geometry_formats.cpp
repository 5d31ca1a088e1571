#include "scene/readers/geometry_formats.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "scene/list_names.hpp"
#include "scene/readers/gltf_reader.hpp"
#include "scene/readers/obj_reader.hpp"
#include "scene/readers/ply_reader.hpp"
#include "scene/readers/radiance_reader.hpp"
#include "scene/readers/stl_reader.hpp"

namespace fluxel {
namespace {

constexpr std::array kFormats{
    GeometryFormat{{".obj"}, read_obj_text}, GeometryFormat{{".gltf", ".glb"}, read_gltf},
    GeometryFormat{{".ply"}, read_ply},      GeometryFormat{{".rad"}, read_radiance},
    GeometryFormat{{".stl"}, read_stl},
};

}  // namespace

const GeometryFormat* geometry_format(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  const auto found = std::ranges::find_if(kFormats, [&](const GeometryFormat& format) {
    return !extension.empty() && std::ranges::find(format.extensions, extension) != format.extensions.end();
  });
  return found == kFormats.end() ? nullptr : &*found;
}

std::string geometry_extensions() {
  std::vector<std::string> known;
  for (const GeometryFormat& format : kFormats) {
    for (const std::string_view extension : format.extensions) {
      if (!extension.empty()) known.emplace_back(extension);
    }
  }
  return list_names(known);
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace fluxel

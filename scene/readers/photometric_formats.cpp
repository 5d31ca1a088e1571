#include "scene/readers/photometric_formats.hpp"

#include <algorithm>
#include <vector>

#include "scene/list_names.hpp"
#include "scene/readers/eulumdat_file.hpp"
#include "scene/readers/geometry_formats.hpp"
#include "scene/readers/ies_file.hpp"

namespace fluxel {
namespace {

constexpr std::array kPhotometricFormats{
    PhotometricFormat{{".ies"}, read_ies_text},
    PhotometricFormat{{".ldt", ".eul"}, read_eulumdat_text},
};

}  // namespace

const PhotometricFormat* photometric_format(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  const auto found = std::ranges::find_if(kPhotometricFormats, [&](const PhotometricFormat& format) {
    return !extension.empty() && std::ranges::find(format.extensions, extension) != format.extensions.end();
  });
  return found == kPhotometricFormats.end() ? nullptr : &*found;
}

std::string photometric_extensions() {
  std::vector<std::string> known;
  for (const PhotometricFormat& format : kPhotometricFormats)
    for (const std::string_view extension : format.extensions)
      if (!extension.empty()) known.emplace_back(extension);
  return list_names(known);
}

}  // namespace fluxel

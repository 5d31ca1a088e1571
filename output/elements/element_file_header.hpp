#pragma once

#include <string_view>

namespace fluxel {

// Lines of the header of a file of elements, for its writer and its reader.

inline constexpr std::string_view kPlyVersionComment = "comment Fluxel ";
inline constexpr std::string_view kPlyUnits =
    "comment radiosity in W/m2 (or lm/m2, as the scene's emission), lengths in m";
inline constexpr std::string_view kPlyVertices = "element vertex ";
inline constexpr std::string_view kPlyFaces = "element face ";
inline constexpr std::string_view kPlyCorners = "property list uchar uint vertex_indices";
/// Of a face as programs show it: lines of the header, which older files lack.
inline constexpr std::string_view kPlyRgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
inline constexpr std::string_view kPlyFloat = "property float ";
inline constexpr std::string_view kPlyPatch = "property uint patch";
/// Endings of a layer's three properties.
inline constexpr std::string_view kPlyColours[] = {"_r", "_g", "_b"};

}  // namespace fluxel

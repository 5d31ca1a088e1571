#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fluxel {

enum class PlyEncoding { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

[[nodiscard]] std::size_t bytes_of(PlyType type);
[[nodiscard]] bool is_whole(PlyType type);

/// A number of each item of an element, or a list of them.
struct PlyProperty {
  std::string name;
  PlyType type{};                     ///< of the number, or of each in the list
  std::optional<PlyType> list_count;  ///< of the list's length; none: this is no list
};

/// A table of the file, as `vertex` or `face`.
struct PlyElement {
  std::string name;
  std::uint64_t items = 0;
  std::vector<PlyProperty> properties;

  /// The first property of that name.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

struct PlyHeader {
  PlyEncoding encoding{};
  std::vector<PlyElement> elements;  ///< of names that differ, in the order of the file
  std::size_t body = 0;              ///< the first byte behind the header
  std::size_t body_line = 0;         ///< and its line
};

/// Reads the header of a PLY file (Turk, The PLY Polygon File Format, 1994). Numbers of items are such that
/// the rest of the file may hold them. Throws InputError with file and line.
[[nodiscard]] PlyHeader read_ply_header(const std::filesystem::path& file, const std::string& bytes);

}  // namespace fluxel

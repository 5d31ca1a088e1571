#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "output/elements/indexed_mesh.hpp"

namespace fluxel {

/// What stands at the faces of a mesh under one name: numbers, or the numbers of things.
struct CellArray {
  std::string name;
  int components = 1;
  std::variant<std::vector<float>, std::vector<std::uint32_t>> values;  ///< face after face
};

/// A number that a file says of the whole.
struct FieldNumber {
  std::string name;
  double value = 0;
};

/// Writes an unstructured grid of VTK's XML format (.vtu, version 1.0): triangles and quads, points in double
/// precision, arrays appended raw and compressed by zlib. `about` is a comment of the file: its arrays of
/// text are what not all readers know (meshio 5). Throws InputError where the file cannot be written (nothing
/// then stands under its name), std::logic_error where an array has not `components` values a face.
void write_vtu(const std::filesystem::path& file, const IndexedMesh& mesh, std::span<const CellArray> cells,
               std::span<const FieldNumber> fields, std::string about);

}  // namespace fluxel

#include "output/elements/vtu_writer.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <stdexcept>

#include "core/file.hpp"

namespace fluxel {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little endian");

/// Of what is compressed at once, as VTK's own writer has it.
constexpr std::size_t kBlockBytes = 32768;

/// Of zlib: one of its fast levels, since files are written while the ranks wait.
constexpr int kLevel = 3;

/// Cell types of VTK.
constexpr std::uint8_t kTriangle = 5, kQuad = 9;

constexpr const char* kTypeOfFloat = "Float32";
constexpr const char* kTypeOfNumber = "UInt32";

/// The data at the end of the file: arrays, each with the sizes of its compressed blocks.
class Appended {
 public:
  /// Returns where the array stands.
  template <class T>
  std::size_t add(const std::vector<T>& values) {
    const std::size_t offset = bytes_.size();
    const auto raw = std::as_bytes(std::span(values));
    const std::size_t rest = raw.size() % kBlockBytes;
    std::vector<std::uint64_t> sizes{(raw.size() + kBlockBytes - 1) / kBlockBytes, kBlockBytes, rest};
    std::string blocks;
    for (std::size_t at = 0; at < raw.size(); at += kBlockBytes)
      sizes.push_back(append_compressed(raw.subspan(at, std::min(kBlockBytes, raw.size() - at)), blocks));
    append_raw(std::as_bytes(std::span(sizes)));
    bytes_ += blocks;
    return offset;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void append_raw(std::span<const std::byte> raw) {
    bytes_.append(reinterpret_cast<const char*>(raw.data()), raw.size());
  }
  static std::uint64_t append_compressed(std::span<const std::byte> raw, std::string& to) {
    uLongf size = compressBound(static_cast<uLong>(raw.size()));
    const std::size_t before = to.size();
    to.resize(before + size);
    if (compress2(reinterpret_cast<Bytef*>(to.data() + before), &size,
                  reinterpret_cast<const Bytef*>(raw.data()), static_cast<uLong>(raw.size()), kLevel) != Z_OK)
      throw std::bad_alloc();
    to.resize(before + size);
    return size;
  }

  std::string bytes_;
};

/// The elements of the file before its data.
class Head {
 public:
  template <class... Args>
  void line(fmt::format_string<Args...> form, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Args>(args)...);
    text_ += '\n';
  }
  template <class T>
  void array(const char* type, std::string_view name, int components, const std::vector<T>& values,
             Appended& data) {
    line(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)", type,
         name, components, data.add(values));
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add_fields(std::span<const FieldNumber> fields, Head& head) {
  head.line("<FieldData>");
  for (const FieldNumber& field : fields)
    head.line(R"(<DataArray type="Float64" Name="{}" NumberOfTuples="1" format="ascii">{}</DataArray>)",
              field.name, field.value);
  head.line("</FieldData>");
}

void add_mesh(const IndexedMesh& mesh, Head& head, Appended& data) {
  std::vector<double> points;
  points.reserve(3 * mesh.vertices.size());
  for (const glm::dvec3& vertex : mesh.vertices) points.insert(points.end(), {vertex.x, vertex.y, vertex.z});
  head.line("<Points>");
  head.array("Float64", "Points", 3, points, data);
  head.line("</Points>");
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  for (const IndexedMesh::Face& face : mesh.faces) {
    connectivity.insert(connectivity.end(), face.vertex.begin(), face.vertex.begin() + face.corners);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(face.corners == 3 ? kTriangle : kQuad);
  }
  head.line("<Cells>");
  head.array("Int64", "connectivity", 1, connectivity, data);
  head.array("Int64", "offsets", 1, offsets, data);
  head.array("UInt8", "types", 1, types, data);
  head.line("</Cells>");
}

void add_cells(const IndexedMesh& mesh, std::span<const CellArray> cells, Head& head, Appended& data) {
  head.line("<CellData>");
  for (const CellArray& array : cells)
    std::visit(
        [&](const auto& values) {
          if (values.size() != static_cast<std::size_t>(array.components) * mesh.faces.size())
            throw std::logic_error("VTU: " + array.name + " has not its values at each face");
          using Value = typename std::decay_t<decltype(values)>::value_type;
          head.array(std::is_same_v<Value, float> ? kTypeOfFloat : kTypeOfNumber, array.name,
                     array.components, values, data);
        },
        array.values);
  head.line("</CellData>");
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const IndexedMesh& mesh, std::span<const CellArray> cells,
               std::span<const FieldNumber> fields, std::string about) {
  Head head;
  Appended data;
  head.line(R"(<?xml version="1.0"?>)");
  // Two hyphens would end the comment.
  for (std::size_t at = about.find("--"); at != std::string::npos; at = about.find("--")) about[at] = ' ';
  head.line("<!-- {} -->", about);
  head.line(
      R"(<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">)");
  head.line("<UnstructuredGrid>");
  add_fields(fields, head);
  head.line(R"(<Piece NumberOfPoints="{}" NumberOfCells="{}">)", mesh.vertices.size(), mesh.faces.size());
  add_mesh(mesh, head, data);
  add_cells(mesh, cells, head, data);
  head.line("</Piece>\n</UnstructuredGrid>");
  head.line(R"(<AppendedData encoding="raw">)");
  write_bytes_atomically(file, head.text() + "_" + data.bytes() + "\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace fluxel

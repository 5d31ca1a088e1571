#include "scene/readers/ply_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/input_error_at.hpp"
#include "core/srgb.hpp"
#include "scene/list_names.hpp"
#include "scene/readers/colour_bins.hpp"
#include "scene/readers/default_material.hpp"
#include "scene/readers/format_limits.hpp"
#include "scene/readers/ply_header.hpp"
#include "scene/readers/ply_values.hpp"

namespace fluxel {
namespace {

constexpr double kLongestList = 4294967295;  // what a uint counts

/// Which properties of an element hold a position or colour.
using Columns = std::array<std::size_t, 3>;

class PlyReader {
 public:
  PlyReader(const std::filesystem::path& file, const std::string& bytes)
      : file_(file), header_(read_ply_header(file, bytes)), values_(file, bytes, header_) {}

  SceneInput run() {
    find_columns();
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        skip(element);
      }
    }
    return make_scene();
  }

 private:
  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const {
    return input_error_at(file_, 0, what, hint);
  }

  [[nodiscard]] const PlyElement* element(std::string_view name) const {
    const auto found = std::ranges::find(header_.elements, name, &PlyElement::name);
    return found == header_.elements.end() ? nullptr : &*found;
  }

  void find_columns() {
    const PlyElement* const vertex = element("vertex");
    const PlyElement* const face = element("face");
    if (vertex == nullptr) throw error("has no element 'vertex'");
    if (face == nullptr || face->items == 0) {
      const bool strips = element("tristrips") != nullptr;
      throw error("holds no face", strips ? "strips of triangles are not read: save it with faces"
                                          : "a cloud of points has no surface");
    }
    find_position(*vertex);
    find_corners(*face);
    vertex_rgb_ = find_rgb(*vertex);
    face_rgb_ = find_rgb(*face);
    note_others(*vertex, position_, vertex_rgb_);
    note_others(*face, std::array{face_corners_}, face_rgb_);
    for (const PlyElement& other : header_.elements)
      if (&other != vertex && &other != face) ignored_.push_back(fmt::format("element '{}'", other.name));
    vertices_ = vertex->items;
  }

  void find_position(const PlyElement& vertex) {
    constexpr std::array kNames{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<std::size_t> column = vertex.find(kNames[axis]);
      if (!column || vertex.properties[*column].list_count)
        throw error(fmt::format("element 'vertex' has no property '{}' that is a number", kNames[axis]));
      position_[axis] = *column;
    }
  }

  void find_corners(const PlyElement& face) {
    std::optional<std::size_t> column = face.find("vertex_indices");
    if (!column) column = face.find("vertex_index");
    if (!column || !face.properties[*column].list_count || !is_whole(face.properties[*column].type)) {
      throw error("element 'face' has no list 'vertex_indices' of whole numbers",
                  "property list uchar int vertex_indices");
    }
    face_corners_ = *column;
  }

  /// Three numbers of one type that is a colour's.
  static std::optional<Columns> find_rgb(const PlyElement& element) {
    constexpr std::array kNames{"red", "green", "blue"};
    Columns rgb{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::optional<std::size_t> column = element.find(kNames[c]);
      if (!column || element.properties[*column].list_count) return std::nullopt;
      rgb[c] = *column;
    }
    const PlyType type = element.properties[rgb[0]].type;
    const bool agree = element.properties[rgb[1]].type == type && element.properties[rgb[2]].type == type;
    const bool known = type == PlyType::uint8 || !is_whole(type);
    return agree && known ? std::optional(rgb) : std::nullopt;
  }

  void note_others(const PlyElement& element, std::span<const std::size_t> read,
                   const std::optional<Columns>& rgb) {
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const bool colour = rgb && std::ranges::count(*rgb, k) > 0;
      if (!colour && std::ranges::count(read, k) == 0)
        ignored_.push_back(fmt::format("'{}' of {}", element.properties[k].name, element.name));
    }
  }

  /// Reads an item into item_ and, of the list of a face's corners, list_.
  void read_item(const PlyElement& element, std::optional<std::size_t> kept_list = std::nullopt) {
    values_.begin_item();
    item_.clear();
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (!property.list_count) {
        item_.push_back(values_.next(property.type, property.name.c_str()));
        continue;
      }
      const std::size_t length = read_length(property);
      item_.push_back(static_cast<double>(length));
      if (kept_list == k) {
        read_corners(property, length);
      } else {
        for (std::size_t i = 0; i < length; ++i) values_.next(property.type, property.name.c_str());
      }
    }
  }

  std::size_t read_length(const PlyProperty& list) {
    const double length = values_.next(*list.list_count, list.name.c_str());
    if (!(length >= 0 && length <= kLongestList))
      throw values_.error(fmt::format("{}: a list of length {}", list.name, length));
    return static_cast<std::size_t>(length);
  }

  void read_corners(const PlyProperty& property, std::size_t length) {
    if (length < 3)
      throw values_.error(fmt::format("a face needs at least 3 corners, this one has {}", length));
    if (length > kMaxFaceCorners) {
      throw values_.error(fmt::format("a face of {} corners", length),
                          fmt::format("at most {}", kMaxFaceCorners));
    }
    for (std::size_t i = 0; i < length; ++i) {
      const double corner = values_.next(property.type, "vertex index");
      if (!(corner >= 0 && corner < static_cast<double>(vertices_))) {
        throw values_.error(fmt::format("vertex index {} is out of range", corner),
                            fmt::format("the file has {} vertices, counted from 0", vertices_));
      }
      corners_.push_back(static_cast<std::uint32_t>(corner));
    }
    sizes_.push_back(static_cast<std::uint32_t>(length));
  }

  void read_vertices(const PlyElement& vertex) {
    positions_.reserve(vertex.items);
    for (std::uint64_t i = 0; i < vertex.items; ++i) {
      read_item(vertex);
      glm::dvec3& position = positions_.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        position[axis] = item_[position_[static_cast<std::size_t>(axis)]];
        if (!(std::abs(position[axis]) <= kMaxCoordinate)) {
          throw values_.error(fmt::format("vertex coordinate {} is not finite or too large", position[axis]),
                              fmt::format("at most {}", kMaxCoordinate));
        }
      }
      if (vertex_rgb_) vertex_rho_.push_back(read_rho(vertex, *vertex_rgb_));
    }
  }

  void read_faces(const PlyElement& face) {
    for (std::uint64_t i = 0; i < face.items; ++i) {
      read_item(face, face_corners_);
      if (face_rgb_) face_rho_.push_back(read_rho(face, *face_rgb_));
    }
  }

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t i = 0; i < element.items; ++i) read_item(element);
  }

  [[nodiscard]] Rgb read_rho(const PlyElement& element, const Columns& columns) const {
    const bool srgb = element.properties[columns[0]].type == PlyType::uint8;
    Rgb rho;
    for (int c = 0; c < kChannels; ++c) {
      const double value = item_[columns[static_cast<std::size_t>(c)]];
      const double most = srgb ? 255 : 1;
      if (!(value >= 0 && value <= most)) {
        throw values_.error(fmt::format("colour {} outside 0..{}", value, most),
                            "colours are read as reflectances");
      }
      rho[c] = srgb ? decode_srgb(static_cast<std::uint8_t>(value)) : value;
    }
    return rho;
  }

  [[nodiscard]] Rgb rho_of(std::size_t face, std::span<const std::uint32_t> corners) const {
    if (face_rgb_) return face_rho_[face];
    Rgb sum(0);
    for (const std::uint32_t corner : corners) sum += vertex_rho_[corner];
    return sum / static_cast<double>(corners.size());
  }

  SceneInput make_scene() {
    SceneInput scene;
    scene.name = file_.stem().string();
    scene.file = file_;
    scene.geometry.push_back({.file = file_});
    scene.groups.push_back(scene.name);
    const bool coloured = face_rgb_ || vertex_rgb_;
    ColourBins bins;
    scene.polygons.reserve(sizes_.size());
    const std::uint32_t* next = corners_.data();
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const std::span<const std::uint32_t> corners(next, sizes_[i]);
      next += sizes_[i];
      InputPolygon& polygon = scene.polygons.emplace_back();
      polygon.corners.reserve(corners.size());
      for (const std::uint32_t corner : corners) polygon.corners.push_back(positions_[corner]);
      if (coloured) polygon.material = bins.add(rho_of(i, corners));
    }
    scene.materials = bins.materials();
    if (!coloured) {
      InputMaterial& material = scene.materials.emplace_back();
      material.name = kDefaultMaterial;
      scene.notes.push_back(
          fmt::format("{}: no colours: all {} faces have one material, '{}' unless [[geometry]] names it, of "
                      "reflectance {} "
                      "unless [materials] sets it",
                      file_.string(), sizes_.size(), kDefaultMaterial, material.rho.r));
    }
    if (!ignored_.empty())
      scene.notes.push_back(fmt::format("{}: ignored: {}", file_.string(), list_names(ignored_)));
    return scene;
  }

  const std::filesystem::path& file_;
  PlyHeader header_;
  PlyValues values_;
  Columns position_{};
  std::size_t face_corners_ = 0;
  std::optional<Columns> vertex_rgb_, face_rgb_;
  std::vector<std::string> ignored_;
  std::uint64_t vertices_ = 0;
  std::vector<double> item_;  // a number for each property of the last item; of a list its length
  std::vector<glm::dvec3> positions_;
  std::vector<Rgb> vertex_rho_, face_rho_;  // empty: without colours
  std::vector<std::uint32_t> corners_;      // of all faces
  std::vector<std::uint32_t> sizes_;        // how many of each face
};

}  // namespace

SceneInput read_ply(const std::filesystem::path& file, const std::string& bytes, const TextLookup&) {
  return PlyReader(file, bytes).run();
}

}  // namespace fluxel

#include "output/html/shown_mesh.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <new>
#include <unordered_map>

#include "core/hash.hpp"
#include "output/html/base64.hpp"

namespace fluxel {

namespace {

using MeshJson = nlohmann::ordered_json;
using Shape = std::vector<glm::vec3>;

/// Polygons and what they have, element by element or joined.
struct Polygons {
  std::vector<Shape> shapes;
  std::vector<std::uint32_t> group, material;
  std::vector<MeshLayer> layers;
  std::size_t left_out = 0;  ///< the smallest, where there would be too many
};

glm::vec3 area_vector(const Outline<glm::vec3>& outline) {
  glm::vec3 sum(0);
  for (std::size_t k = 2; k < outline.corners; ++k)
    sum += glm::cross(outline.corner[k - 1] - outline.corner[0], outline.corner[k] - outline.corner[0]);
  return 0.5F * sum;
}

Shape shape_of(const Outline<glm::vec3>& outline) {
  return {outline.corner.begin(), outline.corner.begin() + outline.corners};
}

Polygons single(const MeshToShow& mesh) {
  Polygons polygons{{}, mesh.group, mesh.material, mesh.layers, 0};
  polygons.shapes.reserve(mesh.outlines.size());
  for (const Outline<glm::vec3>& outline : mesh.outlines) polygons.shapes.push_back(shape_of(outline));
  return polygons;
}

/// Of a patch, the axes of its plane.
struct Axes {
  glm::vec3 normal{0}, u{0}, v{0};
};

Axes axes_of(const glm::vec3& normal) {
  const glm::vec3 n = glm::normalize(normal);
  const glm::vec3 other = std::abs(n.x) < 0.6F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 u = glm::normalize(glm::cross(other, n));
  return {n, u, glm::cross(n, u)};
}

/// A square of a patch's plane.
struct Square {
  std::uint32_t patch = 0;
  std::int32_t u = 0, v = 0;

  bool operator==(const Square&) const = default;
};

struct HashSquare {
  std::size_t operator()(const Square& square) const {
    return hash_bytes(std::as_bytes(std::span(&square, 1)));
  }
};

/// Joins elements of `size` [m] or less; `square` of each element.
class Joined {
 public:
  Joined(const MeshToShow& mesh, std::span<const Axes> axes, float size) {
    std::unordered_map<Square, std::uint32_t, HashSquare> numbers;
    for (std::size_t k = 0; k < mesh.outlines.size(); ++k) {
      const Outline<glm::vec3>& outline = mesh.outlines[k];
      glm::vec3 middle(0);
      for (std::size_t c = 0; c < outline.corners; ++c)
        middle += outline.corner[c] / static_cast<float>(outline.corners);
      const Axes& of = axes[mesh.patch[k]];
      const auto place = [&](const glm::vec3& axis) {
        constexpr float kFarthest = 1e9F;
        return static_cast<std::int32_t>(
            std::clamp(std::floor(glm::dot(middle, axis) / size), -kFarthest, kFarthest));
      };
      const auto next = static_cast<std::uint32_t>(numbers.size());
      number_.push_back(numbers.try_emplace({mesh.patch[k], place(of.u), place(of.v)}, next).first->second);
    }
    count_ = numbers.size();
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::uint32_t of(std::size_t element) const { return number_[element]; }

 private:
  std::vector<std::uint32_t> number_;
  std::size_t count_ = 0;
};

float turn(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const Axes& axes) {
  return glm::dot(glm::cross(b - a, c - b), axes.normal);
}

/// Of points of a plane (Andrew 1979, monotone chain), counter-clockwise about the normal.
Shape convex_hull(Shape points, const Axes& axes) {
  const auto key = [&](const glm::vec3& p) { return std::pair(glm::dot(p, axes.u), glm::dot(p, axes.v)); };
  std::ranges::sort(points, {}, key);
  Shape hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const glm::vec3& point : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), point, axes) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  constexpr std::size_t kMostCorners = 255;
  if (hull.size() > kMostCorners) hull.resize(kMostCorners);
  return hull;
}

Polygons joined(MeshToShow mesh, std::size_t most) {
  const std::size_t count = mesh.outlines.size();
  // A file may have any numbers.
  std::unordered_map<std::uint32_t, std::uint32_t> numbers;
  for (std::uint32_t& patch : mesh.patch)
    patch = numbers.try_emplace(patch, static_cast<std::uint32_t>(numbers.size())).first->second;
  std::vector<Axes> axes(numbers.size());
  std::vector<float> areas;
  double area = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const glm::vec3 along = area_vector(mesh.outlines[k]);
    areas.push_back(glm::length(along));
    area += static_cast<double>(areas.back());
    if (Axes& of = axes[mesh.patch[k]]; of.normal == glm::vec3(0) && areas.back() > 0) of = axes_of(along);
  }
  // The first size would do were all elements small; patches smaller than it have a square each whatever it
  // is.
  constexpr float kGrowth = 1.3F;
  constexpr int kTries = 24;
  auto size = std::max(static_cast<float>(std::sqrt(area / static_cast<double>(most))) / kGrowth,
                       std::numeric_limits<float>::min());
  Joined squares(mesh, axes, size);
  for (int k = 0; k < kTries && squares.count() > most; ++k) squares = Joined(mesh, axes, size *= kGrowth);

  Polygons polygons;
  std::vector<Shape> corners(squares.count());
  std::vector<std::uint32_t> first(squares.count());
  std::vector<float> area_of(squares.count(), 0);
  for (std::size_t k = count; k-- > 0;) {
    const Shape shape = shape_of(mesh.outlines[k]);
    corners[squares.of(k)].insert(corners[squares.of(k)].end(), shape.begin(), shape.end());
    first[squares.of(k)] = static_cast<std::uint32_t>(k);
    area_of[squares.of(k)] += areas[k];
  }
  std::vector<std::uint32_t> kept(squares.count());
  for (std::size_t k = 0; k < kept.size(); ++k) kept[k] = static_cast<std::uint32_t>(k);
  if (kept.size() > most) {
    std::ranges::stable_sort(kept, std::greater{}, [&](std::uint32_t k) { return area_of[k]; });
    polygons.left_out = kept.size() - most;
    kept.resize(most);
  }
  for (const std::uint32_t k : kept) {
    polygons.shapes.push_back(convex_hull(std::move(corners[k]), axes[mesh.patch[first[k]]]));
    if (!mesh.group.empty()) polygons.group.push_back(mesh.group[first[k]]);
    if (!mesh.material.empty()) polygons.material.push_back(mesh.material[first[k]]);
  }
  for (const MeshLayer& layer : mesh.layers) {
    const std::size_t components = layer.components;
    std::vector<double> sums(squares.count() * components), weights(sums.size());
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < components; ++c) {
        const float value = layer.values[k * components + c];
        if (!std::isfinite(value)) continue;
        sums[squares.of(k) * components + c] += static_cast<double>(areas[k] * value);
        weights[squares.of(k) * components + c] += static_cast<double>(areas[k]);
      }
    MeshLayer mean{layer.name, components, {}};
    for (const std::uint32_t k : kept)
      for (std::size_t c = 0; c < components; ++c)
        mean.values.push_back(static_cast<float>(sums[k * components + c] / weights[k * components + c]));
    polygons.layers.push_back(std::move(mean));
  }
  return polygons;
}

/// Arrays one after another, and where each is.
class Packing {
 public:
  template <class T>
  void add(const char* name, const char* type, const std::vector<T>& values) {
    layout_.push_back({{"name", name}, {"type", type}, {"count", values.size()}});
    const std::size_t before = bytes_.size(), size = values.size() * sizeof(T);
    bytes_.resize(before + size);
    if (size > 0) std::memcpy(bytes_.data() + before, values.data(), size);
  }

  void add_indices(const char* name, const std::vector<std::uint32_t>& values) {
    const std::uint32_t largest = values.empty() ? 0 : *std::ranges::max_element(values);
    if (largest > std::numeric_limits<std::uint16_t>::max())
      add(name, "u32", values);
    else
      add(name, "u16", std::vector<std::uint16_t>(values.begin(), values.end()));
  }

  /// Of single precision 14 bits are kept, more than a page shows, so that they deflate well.
  void add_values(const MeshLayer& layer) {
    constexpr std::uint32_t kKept = 0xFFFFFC00U, kHalf = 0x200U;
    std::vector<std::uint32_t> kept;
    kept.reserve(layer.values.size());
    for (const float value : layer.values)
      kept.push_back(std::isfinite(value)
                         ? (std::bit_cast<std::uint32_t>(value) + kHalf) & kKept
                         : std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()));
    add(layer.name.c_str(), "f32", kept);
  }

  void write(MeshJson& json) const {
    constexpr int kLevel = 6;
    uLongf size = compressBound(bytes_.size());
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes_.data()), bytes_.size(), kLevel) != Z_OK)
      throw std::bad_alloc();
    packed.resize(size);
    json["layout"] = layout_;
    json["packed"] = base64(packed);
  }

 private:
  MeshJson layout_ = MeshJson::array();
  std::string bytes_;
};

MeshJson vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

MeshLayer layer_of(std::string name, std::span<const Rgb> values) {
  MeshLayer layer{std::move(name), kChannels, {}};
  layer.values.reserve(values.size() * kChannels);
  for (const Rgb& value : values)
    for (int c = 0; c < kChannels; ++c) layer.values.push_back(static_cast<float>(value[c]));
  return layer;
}

MeshJson shown_mesh(const MeshToShow& mesh, std::size_t most) {
  const bool is_joined = mesh.outlines.size() > most;
  const Polygons polygons = is_joined ? joined(mesh, most) : single(mesh);
  glm::vec3 least(std::numeric_limits<float>::max()), largest(std::numeric_limits<float>::lowest());
  for (const Shape& shape : polygons.shapes)
    for (const glm::vec3& corner : shape)
      least = glm::min(least, corner), largest = glm::max(largest, corner);
  const glm::vec3 size = largest - least;
  const float step = std::max({size.x, size.y, size.z, std::numeric_limits<float>::min()});
  std::vector<std::uint8_t> corners;
  std::vector<std::uint16_t> positions;
  for (const Shape& shape : polygons.shapes) {
    corners.push_back(static_cast<std::uint8_t>(shape.size()));
    for (const glm::vec3& corner : shape)
      for (int c = 0; c < 3; ++c)
        positions.push_back(
            static_cast<std::uint16_t>(std::lround((corner[c] - least[c]) / step * 65535.0F)));
  }
  Packing packing;
  packing.add("corners", "u8", corners);
  packing.add("positions", "u16", positions);
  for (const MeshLayer& layer : polygons.layers) packing.add_values(layer);
  if (!polygons.group.empty()) packing.add_indices("group", polygons.group);
  if (!polygons.material.empty()) packing.add_indices("material", polygons.material);
  MeshJson reflectances = MeshJson::array();
  for (const Rgb& rho : mesh.reflectance) reflectances.push_back(vector_json(rho));
  MeshJson json{
      {"elements", mesh.outlines.size()}, {"decimated", is_joined},    {"left_out", polygons.left_out},
      {"least", vector_json(least)},      {"size", vector_json(size)}, {"step", step},
      {"up", vector_json(mesh.up)},       {"groups", mesh.groups},     {"materials", mesh.materials},
      {"reflectance", reflectances},      {"error_is", mesh.error_is}, {"error_unit", mesh.error_unit},
      {"diverging", mesh.is_signed}};
  packing.write(json);
  return json;
}

}  // namespace fluxel

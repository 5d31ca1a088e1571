#include "scene/readers/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace fluxel {
namespace {

enum ComponentType { kInt8 = 5120, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32 };  // of OpenGL

constexpr std::array<std::string_view, 3> kTypes{"SCALAR", "VEC2", "VEC3"};  // by their components

template <class Component>
double read_component(const char* from, bool normalized) {
  Component value;
  std::memcpy(&value, from, sizeof value);
  const auto number = static_cast<double>(value);
  if (!normalized) return number;
  return std::max(number / static_cast<double>(std::numeric_limits<Component>::max()), -1.0);
}

std::size_t component_bytes(int component_type) {
  if (component_type < kInt16) return 1;
  return component_type < kInt32 ? 2 : 4;
}

bool is_unsigned(int component_type) {
  return component_type == kUint8 || component_type == kUint16 || component_type == kUint32;
}

/// Elements of a buffer view, from a byte of it on, as `given` has both. `stride` 0: without gaps.
GltfElements elements_of(const GltfFile& gltf, const std::string& where, const GltfValue& given,
                         std::size_t count, std::size_t stride, GltfElements kind) {
  const std::size_t view = given["bufferView"].whole(), from = given["byteOffset"].whole();
  const std::string_view bytes = buffer_view_bytes(gltf, view);
  const std::size_t size = component_bytes(kind.component_type) * static_cast<std::size_t>(kind.components);
  kind.stride = stride == 0 ? size : stride;
  if (kind.stride < size) {
    throw gltf.error(where, fmt::format("elements of {} bytes are {} bytes apart", size, kind.stride));
  }
  // Counts and bytes are below 2^53 and strides below 2^8, so nothing overflows.
  if (from + (count - 1) * kind.stride + size > bytes.size()) {
    throw gltf.error(
        where, fmt::format("{} elements from byte {} on reach beyond bufferViews[{}]", count, from, view),
        fmt::format("it has {} bytes", bytes.size()));
  }
  kind.bytes = bytes.substr(from);
  return kind;
}

}  // namespace

double GltfElements::at(std::size_t element, int component) const {
  const std::size_t size = component_bytes(component_type);
  const char* const from = bytes.data() + element * stride + static_cast<std::size_t>(component) * size;
  switch (component_type) {
    case kInt8:
      return read_component<std::int8_t>(from, normalized);
    case kUint8:
      return read_component<std::uint8_t>(from, normalized);
    case kInt16:
      return read_component<std::int16_t>(from, normalized);
    case kUint16:
      return read_component<std::uint16_t>(from, normalized);
    case kUint32:
      return read_component<std::uint32_t>(from, normalized);
    default:
      return read_component<float>(from, false);
  }
}

GltfAccessor::GltfAccessor(const GltfFile& gltf, std::size_t accessor, int components) {
  const GltfValue given = gltf["accessors"][accessor];
  const GltfValue view = given["bufferView"], sparse = given["sparse"];
  const std::string where = gltf_element("accessors", accessor);
  elements_.component_type = static_cast<int>(given["componentType"].whole());
  elements_.components = components;
  elements_.normalized = given["normalized"].is_true();
  if (elements_.component_type == kInt32) throw gltf.error(where + ".componentType", "5124 is not allowed");
  if (given["type"].text() != kTypes[static_cast<std::size_t>(components - 1)]) {
    throw gltf.error(where + ".type", "not what it is used for",
                     "indices are SCALAR, texture coordinates VEC2, positions VEC3");
  }
  if (!view.given() && !sparse.given()) throw gltf.error(where, "has no data");
  size_ = given["count"].whole();
  if (view.given()) {
    const std::size_t stride = gltf["bufferViews"][view.whole()]["byteStride"].whole();
    elements_ = elements_of(gltf, where, given, size_, stride, elements_);
  }
  if (sparse.given()) add_sparse(gltf, sparse, where + ".sparse");
}

void GltfAccessor::add_sparse(const GltfFile& gltf, const GltfValue& sparse, const std::string& where) {
  replacements_ = sparse["count"].whole();
  replaced_.component_type = static_cast<int>(sparse["indices"]["componentType"].whole());
  if (!is_unsigned(replaced_.component_type))
    throw gltf.error(where + ".indices.componentType", "must be 5121, 5123 or 5125");
  replaced_ = elements_of(gltf, where + ".indices", sparse["indices"], replacements_, 0, replaced_);
  values_ = elements_of(gltf, where + ".values", sparse["values"], replacements_, 0, elements_);
  double last = -1;
  for (std::size_t k = 0; k < replacements_; ++k) {
    const double index = replaced_.at(k, 0);
    if (!(index > last && index < static_cast<double>(size_)))
      throw gltf.error(where + ".indices",
                       fmt::format("{} behind {} does not ascend below {}", index, last, size_));
    last = index;
  }
}

bool GltfAccessor::is_index() const { return !elements_.normalized && is_unsigned(elements_.component_type); }

glm::dvec4 GltfAccessor::operator[](std::size_t element) const {
  const GltfElements* from = elements_.bytes.empty() ? nullptr : &elements_;
  std::size_t place = element;
  std::size_t low = 0, high = replacements_;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (replaced_.at(middle, 0) < static_cast<double>(element)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low < replacements_ && replaced_.at(low, 0) == static_cast<double>(element)) {
    from = &values_;
    place = low;
  }
  glm::dvec4 value(0);
  if (from == nullptr) return value;
  for (int k = 0; k < from->components; ++k) value[k] = from->at(place, k);
  return value;
}

}  // namespace fluxel

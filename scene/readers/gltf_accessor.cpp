#include "scene/readers/gltf_accessor.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace fluxel {
namespace {

template <class Component>
double read_component(const char* from, bool normalized) {
  Component value;
  std::memcpy(&value, from, sizeof value);
  const auto number = static_cast<double>(value);
  if (!normalized) return number;
  return std::max(number / static_cast<double>(std::numeric_limits<Component>::max()), -1.0);
}

std::size_t component_bytes(int component_type) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

bool is_unsigned(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Elements of a buffer view from a byte of it on. `stride` 0: without gaps.
GltfElements elements_of(const GltfFile& gltf, const std::string& where, std::size_t view, std::size_t from,
                         std::size_t count, std::size_t stride, GltfElements kind) {
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
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return read_component<std::int8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return read_component<std::uint8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return read_component<std::int16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return read_component<std::uint16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return read_component<std::uint32_t>(from, normalized);
    default:
      return read_component<float>(from, false);
  }
}

GltfAccessor::GltfAccessor(const GltfFile& gltf, std::size_t accessor, int components) {
  const tinygltf::Accessor& given = gltf.model->accessors[accessor];
  const std::string where = gltf_element("accessors", accessor);
  if (given.componentType == TINYGLTF_COMPONENT_TYPE_INT)
    throw gltf.error(where + ".componentType", "5124 is not allowed");
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(given.type)) != components ||
      given.type > TINYGLTF_TYPE_SCALAR) {
    throw gltf.error(where + ".type", "not what it is used for",
                     "indices are SCALAR, texture coordinates VEC2, positions VEC3");
  }
  if (given.bufferView < 0 && !given.sparse.isSparse) throw gltf.error(where, "has no data");
  size_ = given.count;
  elements_.component_type = given.componentType;
  elements_.components = components;
  elements_.normalized = given.normalized;
  if (given.bufferView >= 0) {
    const auto view = static_cast<std::size_t>(given.bufferView);
    elements_ = elements_of(gltf, where, view, given.byteOffset, size_,
                            gltf.model->bufferViews[view].byteStride, elements_);
  }
  if (given.sparse.isSparse) add_sparse(gltf, accessor);
}

void GltfAccessor::add_sparse(const GltfFile& gltf, std::size_t accessor) {
  const auto& sparse = gltf.model->accessors[accessor].sparse;
  const std::string where = gltf_element("accessors", accessor) + ".sparse";
  replacements_ = static_cast<std::size_t>(sparse.count);
  replaced_.component_type = sparse.indices.componentType;
  if (!is_unsigned(replaced_.component_type))
    throw gltf.error(where + ".indices.componentType", "must be 5121, 5123 or 5125");
  replaced_ = elements_of(gltf, where + ".indices", static_cast<std::size_t>(sparse.indices.bufferView),
                          static_cast<std::size_t>(sparse.indices.byteOffset), replacements_, 0, replaced_);
  values_ = elements_;
  values_ = elements_of(gltf, where + ".values", static_cast<std::size_t>(sparse.values.bufferView),
                        static_cast<std::size_t>(sparse.values.byteOffset), replacements_, 0, values_);
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

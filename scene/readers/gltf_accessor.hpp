#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <string>
#include <string_view>

#include "scene/readers/gltf_file.hpp"

namespace fluxel {

/// Elements in the bytes of a buffer view: one after the other, `stride` bytes apart.
struct GltfElements {
  std::string_view bytes;
  std::size_t stride = 0;
  int component_type = 0;  ///< a number of OpenGL, as glTF files give it
  int components = 1;      ///< of an element
  bool normalized = false;

  /// A component as a number; normalized ones are in 0..1 or -1..1 (glTF 2.0, section 3.11).
  [[nodiscard]] double at(std::size_t element, int component) const;
};

/// An accessor whose every element lies in its buffer; elements that a sparse one replaces are the replacing
/// ones. Refers to the file.
class GltfAccessor {
 public:
  /// Throws InputError with the JSON path where the accessor is not of `components` components, has no data,
  /// or reaches beyond its buffer.
  GltfAccessor(const GltfFile& gltf, std::size_t accessor, int components);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool is_index() const;  ///< of whole numbers that are not negative, and not normalized
  /// An element, with zeros for the components that it lacks.
  [[nodiscard]] glm::dvec4 operator[](std::size_t element) const;

 private:
  void add_sparse(const GltfFile& gltf, const GltfValue& sparse, const std::string& where);

  std::size_t size_ = 0;
  GltfElements elements_;           // without bytes: zeros
  GltfElements replaced_, values_;  // of a sparse one: ascending indices, and the elements there
  std::size_t replacements_ = 0;
};

}  // namespace fluxel

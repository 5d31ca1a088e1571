#pragma once

#include <cstddef>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace fluxel {

/// A value of a checked glTF document, or none, below which stands none. Where there is none, or a value of
/// another type, reading gives the default. Refers to the document.
class GltfValue {
 public:
  explicit GltfValue(const nlohmann::json& value) : value_(&value) {}

  [[nodiscard]] GltfValue operator[](std::string_view key) const;  ///< a member of an object
  [[nodiscard]] GltfValue operator[](std::size_t place) const;     ///< an element of an array
  [[nodiscard]] std::size_t size() const;                          ///< members or elements; of others 0

  [[nodiscard]] bool given() const;
  [[nodiscard]] bool is_true() const;
  [[nodiscard]] double number(double otherwise) const;
  [[nodiscard]] std::size_t whole(std::size_t otherwise = 0) const;
  [[nodiscard]] std::string_view text(std::string_view otherwise = {}) const;
  /// The first numbers of an array.
  template <class Vector>
  [[nodiscard]] Vector vector(Vector otherwise) const {
    for (int k = 0; k < Vector::length(); ++k)
      otherwise[k] = (*this)[static_cast<std::size_t>(k)].number(otherwise[k]);
    return otherwise;
  }

 private:
  const nlohmann::json* value_;
};

/// The name of the first that has one, else `otherwise`.
[[nodiscard]] std::string gltf_name(std::initializer_list<GltfValue> values, const std::string& otherwise);

}  // namespace fluxel

#include "scene/readers/gltf_value.hpp"

#include <nlohmann/json.hpp>

namespace fluxel {
namespace {

const nlohmann::json& no_gltf_value() {
  static const nlohmann::json null;
  return null;
}

}  // namespace

GltfValue GltfValue::operator[](std::string_view key) const {
  const auto member = value_->find(key);
  return GltfValue(member == value_->end() ? no_gltf_value() : *member);
}

GltfValue GltfValue::operator[](std::size_t place) const {
  return GltfValue(value_->is_array() && place < value_->size() ? (*value_)[place] : no_gltf_value());
}

std::size_t GltfValue::size() const { return value_->is_structured() ? value_->size() : 0; }

bool GltfValue::given() const { return !value_->is_null(); }

bool GltfValue::is_true() const { return value_->is_boolean() && value_->get<bool>(); }

double GltfValue::number(double otherwise) const {
  return value_->is_number() ? value_->get<double>() : otherwise;
}

std::size_t GltfValue::whole(std::size_t otherwise) const {
  return value_->is_number_unsigned() ? value_->get<std::size_t>() : otherwise;
}

std::string_view GltfValue::text(std::string_view otherwise) const {
  return value_->is_string() ? value_->get_ref<const std::string&>() : otherwise;
}

std::string gltf_name(std::initializer_list<GltfValue> values, const std::string& otherwise) {
  for (const GltfValue& value : values) {
    const std::string_view name = value["name"].text();
    if (!name.empty()) return std::string(name);
  }
  return otherwise;
}

}  // namespace fluxel

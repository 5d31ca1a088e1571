#include "scene/readers/gltf_schema.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/input_error_at.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

using nlohmann::json;

enum class Kind {
  object,
  objects,  // an array of them
  text,     // one of `words` if there are any
  texts,
  boolean,
  number,   // from `low` to `high`
  numbers,  // an array of `length` of them
  whole,    // not negative, a multiple of `step`
  index,    // of an element of the array `of`
  indices,
};

constexpr double kMaxNumber = 1e15;              // as a coordinate of an OBJ file
constexpr double kMaxStrength = 1e9;             // of emission
constexpr double kMaxWhole = 9007199254740992;   // 2^53, which JSON numbers hold exactly
constexpr std::size_t kMaxItems = 1u << 20;      // of an array of objects
constexpr std::size_t kMaxMaterials = 1u << 16;  // each takes 1 kB when read
constexpr std::string_view kLights = "extensions/KHR_lights_punctual/lights";

struct Rule {
  std::string_view path;  // from the root; * is each element or member
  Kind kind;
  bool required = false;
  double low = -kMaxNumber, high = kMaxNumber;
  std::size_t length = 0;
  std::string_view of = {};
  std::uint64_t step = 1;
  std::string_view words = {};  // with ", " between them
};

constexpr Rule object(std::string_view path, bool required = false) { return {path, Kind::object, required}; }
constexpr Rule objects(std::string_view path, bool required = false) {
  return {path, Kind::objects, required};
}
constexpr Rule text(std::string_view path, bool required = false, std::string_view words = {}) {
  return {path, Kind::text, required, 0, 0, 0, {}, 1, words};
}
constexpr Rule texts(std::string_view path) { return {path, Kind::texts}; }
constexpr Rule boolean(std::string_view path) { return {path, Kind::boolean}; }
constexpr Rule number(std::string_view path, double low, double high) {
  return {path, Kind::number, false, low, high};
}
constexpr Rule numbers(std::string_view path, std::size_t length, double low = -kMaxNumber,
                       double high = kMaxNumber) {
  return {path, Kind::numbers, false, low, high, length};
}
constexpr Rule whole(std::string_view path, double low = 0, double high = kMaxWhole, std::uint64_t step = 1) {
  return {path, Kind::whole, false, low, high, 0, {}, step};
}
constexpr Rule needed(Rule rule) {
  rule.required = true;
  return rule;
}
constexpr Rule index(std::string_view path, std::string_view of) {
  return {path, Kind::index, false, 0, 0, 0, of};
}
constexpr Rule indices(std::string_view path, std::string_view of) {
  return {path, Kind::indices, false, 0, 0, 0, of};
}

constexpr Rule kRules[] = {
    object("asset", true),
    text("asset/version", true),
    texts("extensionsUsed"),
    texts("extensionsRequired"),
    object("extensions"),
    objects("scenes"),
    index("scene", "scenes"),
    objects("nodes"),
    indices("scenes/*/nodes", "nodes"),
    text("nodes/*/name"),
    index("nodes/*/mesh", "meshes"),
    index("nodes/*/camera", "cameras"),
    indices("nodes/*/children", "nodes"),
    numbers("nodes/*/matrix", 16),
    numbers("nodes/*/translation", 3),
    numbers("nodes/*/rotation", 4, -2, 2),
    numbers("nodes/*/scale", 3),
    object("nodes/*/extensions"),
    object("nodes/*/extensions/KHR_lights_punctual"),
    needed(index("nodes/*/extensions/KHR_lights_punctual/light", kLights)),
    objects("meshes"),
    text("meshes/*/name"),
    objects("meshes/*/primitives", true),
    object("meshes/*/primitives/*/attributes", true),
    index("meshes/*/primitives/*/attributes/*", "accessors"),
    index("meshes/*/primitives/*/indices", "accessors"),
    index("meshes/*/primitives/*/material", "materials"),
    whole("meshes/*/primitives/*/mode", 0, 6),
    objects("meshes/*/primitives/*/targets"),
    objects("accessors"),
    index("accessors/*/bufferView", "bufferViews"),
    whole("accessors/*/byteOffset"),
    needed(whole("accessors/*/componentType", 5120, 5126)),
    boolean("accessors/*/normalized"),
    needed(whole("accessors/*/count", 1)),
    text("accessors/*/type", true, "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4"),
    object("accessors/*/sparse"),
    needed(whole("accessors/*/sparse/count", 1)),
    object("accessors/*/sparse/indices", true),
    needed(index("accessors/*/sparse/indices/bufferView", "bufferViews")),
    whole("accessors/*/sparse/indices/byteOffset"),
    needed(whole("accessors/*/sparse/indices/componentType", 5121, 5125)),
    object("accessors/*/sparse/values", true),
    needed(index("accessors/*/sparse/values/bufferView", "bufferViews")),
    whole("accessors/*/sparse/values/byteOffset"),
    objects("bufferViews"),
    needed(index("bufferViews/*/buffer", "buffers")),
    whole("bufferViews/*/byteOffset"),
    needed(whole("bufferViews/*/byteLength", 1)),
    whole("bufferViews/*/byteStride", 4, 252, 4),
    objects("buffers"),
    text("buffers/*/uri"),
    needed(whole("buffers/*/byteLength", 1)),
    objects("materials"),
    text("materials/*/name"),
    boolean("materials/*/doubleSided"),
    text("materials/*/alphaMode"),
    object("materials/*/pbrMetallicRoughness"),
    numbers("materials/*/pbrMetallicRoughness/baseColorFactor", 4, 0, 1),
    number("materials/*/pbrMetallicRoughness/metallicFactor", 0, 1),
    object("materials/*/pbrMetallicRoughness/baseColorTexture"),
    object("materials/*/pbrMetallicRoughness/metallicRoughnessTexture"),
    object("materials/*/normalTexture"),
    object("materials/*/occlusionTexture"),
    needed(index("materials/*/pbrMetallicRoughness/baseColorTexture/index", "textures")),
    needed(index("materials/*/pbrMetallicRoughness/metallicRoughnessTexture/index", "textures")),
    needed(index("materials/*/normalTexture/index", "textures")),
    needed(index("materials/*/occlusionTexture/index", "textures")),
    whole("materials/*/pbrMetallicRoughness/baseColorTexture/texCoord", 0, 255),
    numbers("materials/*/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset", 2,
            -1e6, 1e6),
    numbers("materials/*/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale", 2,
            -1e6, 1e6),
    number("materials/*/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/rotation",
           -1e6, 1e6),
    whole("materials/*/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/texCoord", 0,
          255),
    numbers("materials/*/emissiveFactor", 3, 0, kMaxNumber),
    object("materials/*/emissiveTexture"),
    needed(index("materials/*/emissiveTexture/index", "textures")),
    whole("materials/*/emissiveTexture/texCoord", 0, 255),
    numbers("materials/*/emissiveTexture/extensions/KHR_texture_transform/offset", 2, -1e6, 1e6),
    numbers("materials/*/emissiveTexture/extensions/KHR_texture_transform/scale", 2, -1e6, 1e6),
    number("materials/*/emissiveTexture/extensions/KHR_texture_transform/rotation", -1e6, 1e6),
    whole("materials/*/emissiveTexture/extensions/KHR_texture_transform/texCoord", 0, 255),
    number("materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", 0, kMaxStrength),
    objects("textures"),
    index("textures/*/source", "images"),
    index("textures/*/sampler", "samplers"),
    objects("samplers"),
    whole("samplers/*/wrapS", 0, 65535),
    whole("samplers/*/wrapT", 0, 65535),
    objects("images"),
    text("images/*/uri"),
    index("images/*/bufferView", "bufferViews"),
    objects("cameras"),
    text("cameras/*/name"),
    text("cameras/*/type", true, "perspective, orthographic"),
    object("cameras/*/perspective"),
    needed(number("cameras/*/perspective/yfov", 1e-6, 3.14159)),
    object("extensions/KHR_lights_punctual"),
    objects(kLights, true),
    text("extensions/KHR_lights_punctual/lights/*/name"),
    text("extensions/KHR_lights_punctual/lights/*/type", true),
    numbers("extensions/KHR_lights_punctual/lights/*/color", 3, 0, kMaxNumber),
    number("extensions/KHR_lights_punctual/lights/*/intensity", 0, kMaxNumber),
    object("extensions/KHR_lights_punctual/lights/*/spot"),
    number("extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", 0, 1.5708),
    number("extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", 1e-6, 1.5708),
};

/// Follows one rule through the document.
class RuleWalk {
 public:
  RuleWalk(const std::filesystem::path& file, const json& root, const Rule& rule)
      : file_(file), root_(root), rule_(rule) {
    const json::json_pointer array("/" + std::string(rule.of));
    if (!rule.of.empty() && root.contains(array)) elements_ = root.at(array).size();
  }

  void run() { walk(root_, rule_.path); }

 private:
  struct Step {
    std::string_view key;  // empty: an element
    std::size_t element = 0;
  };

  /// Steps into what the rest of the path names. A value of another kind has a rule of its own, or no reader.
  void walk(const json& value, std::string_view rest) {
    if (rest.empty()) return check(value);
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string_view name = rest.substr(0, slash);
    const std::string_view below = rest.substr(std::min(slash + 1, rest.size()));
    if (name == "*" && value.is_array()) {
      for (std::size_t k = 0; k < value.size(); ++k) step(value[k], {{}, k}, below);
    } else if (name == "*" && value.is_object()) {
      for (const auto& [key, member] : value.items()) step(member, {key}, below);
    } else if (name != "*" && value.is_object()) {
      const auto member = value.find(name);
      if (member != value.end()) {
        step(*member, {name}, below);
      } else if (below.empty() && rule_.required) {
        steps_.push_back({name});
        throw error("is missing");
      }
    }
  }

  void step(const json& value, Step step, std::string_view rest) {
    steps_.push_back(step);
    walk(value, rest);
    steps_.pop_back();
  }

  void check(const json& value) {
    switch (rule_.kind) {
      case Kind::object:
        return require(value.is_object(), "must be an object");
      case Kind::objects: {
        require(value.is_array(), "must be an array of objects");
        const std::size_t most = rule_.path == "materials" ? kMaxMaterials : kMaxItems;
        require(value.size() <= most, "has too many elements");
        return check_each(value, &json::is_object, "must be an object");
      }
      case Kind::text:
        return check_text(value);
      case Kind::texts:
        require(value.is_array(), "must be an array of texts");
        return check_each(value, &json::is_string, "must be a text");
      case Kind::boolean:
        return require(value.is_boolean(), "must be true or false");
      case Kind::number:
        return check_number(value);
      case Kind::numbers:
        if (!value.is_array() || value.size() != rule_.length)
          throw error(fmt::format("must be an array of {} numbers", rule_.length));
        for (const json& element : value) check_number(element);
        return;
      case Kind::whole:
        return check_whole(value);
      case Kind::index:
        return check_index(value);
      case Kind::indices:
        require(value.is_array(), "must be an array of indices");
        for (const json& element : value) check_index(element);
        return;
    }
  }

  void check_each(const json& array, bool (json::*is)() const noexcept, const char* what) {
    for (std::size_t k = 0; k < array.size(); ++k) {
      if ((array[k].*is)()) continue;
      steps_.push_back({{}, k});
      throw error(what);
    }
  }

  void check_text(const json& value) const {
    require(value.is_string(), "must be a text");
    if (rule_.words.empty()) return;
    const auto& given = value.get_ref<const std::string&>();
    const std::string words = fmt::format(", {}, ", rule_.words);
    if (given.find(',') != std::string::npos || words.find(", " + given + ", ") == std::string::npos)
      throw error(fmt::format("{} is unknown", in_quotes(given)), fmt::format("known: {}", rule_.words));
  }

  void check_number(const json& value) const {
    if (!value.is_number()) throw error("must be a number");
    const double given = value.get<double>();
    if (!(given >= rule_.low && given <= rule_.high))
      throw error(fmt::format("{} is outside {}..{}", given, rule_.low, rule_.high));
  }

  void check_whole(const json& value) const {
    if (!value.is_number_unsigned()) throw error("must be a whole number that is not negative");
    const auto given = value.get<std::uint64_t>();
    if (!(static_cast<double>(given) >= rule_.low && static_cast<double>(given) <= rule_.high))
      throw error(fmt::format("{} is outside {}..{}", given, rule_.low, rule_.high));
    if (given % rule_.step != 0) throw error(fmt::format("{} is no multiple of {}", given, rule_.step));
  }

  void check_index(const json& value) const {
    if (!value.is_number_unsigned()) throw error("must be a whole number that is not negative");
    const auto given = value.get<std::uint64_t>();
    if (given >= elements_) {
      throw error(fmt::format("{} is out of range", given),
                  fmt::format("{} has {} elements", rule_.of, elements_));
    }
  }

  void require(bool holds, const char* what) const {
    if (!holds) throw error(what);
  }

  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const {
    std::string where;
    for (const Step& step : steps_) {
      where += step.key.empty() ? fmt::format("[{}]", step.element)
                                : fmt::format("{}{}", where.empty() ? "" : ".", step.key.substr(0, 60));
    }
    return input_error_at(file_, 0, fmt::format("{}: {}", where, what), hint);
  }

  const std::filesystem::path& file_;
  const json& root_;
  const Rule& rule_;
  std::size_t elements_ = 0;
  std::vector<Step> steps_;
};

}  // namespace

void check_gltf_schema(const std::filesystem::path& file, const json& root) {
  for (const Rule& rule : kRules) RuleWalk(file, root, rule).run();
}

}  // namespace fluxel

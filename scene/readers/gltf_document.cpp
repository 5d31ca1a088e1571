#include "scene/readers/gltf_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/input_error_at.hpp"
#include "scene/readers/gltf_schema.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

using nlohmann::json;

constexpr int kMaxJsonDepth = 64;  // of brackets; what Fluxel reads stands at most 9 deep

/// By a count of open brackets: what descends by recursion would run out of stack, and the parser's own hook
/// for it takes the square of the length of an array.
void require_shallow_json(const std::filesystem::path& file, const GltfParts& parts) {
  int depth = 0;
  for (std::size_t k = 0; k < parts.json.size(); ++k) {
    const char c = parts.json[k];
    if (c == '"') {
      for (++k; k < parts.json.size() && parts.json[k] != '"'; ++k) k += parts.json[k] == '\\' ? 1 : 0;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth) {
        throw input_error_at(
            file, 0,
            fmt::format("byte {}: brackets nest more than {} deep", parts.json_at + k, kMaxJsonDepth));
      }
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

json parse_json(const std::filesystem::path& file, const GltfParts& parts) {
  require_shallow_json(file, parts);
  try {
    return json::parse(parts.json);
  } catch (const json::parse_error& failure) {
    const std::size_t byte = std::min(failure.byte, parts.json.size());
    const bool text = parts.json_at == 0;
    const auto lines = std::ranges::count(parts.json.substr(0, byte), '\n');
    throw input_error_at(file, text ? static_cast<std::size_t>(lines) + 1 : 0,
                         fmt::format("not JSON at byte {}", parts.json_at + byte),
                         "a glTF file is JSON or a GLB; is it cut off?");
  } catch (const json::exception& failure) {  // a number beyond the range of double
    const std::string_view message = failure.what();
    const std::string_view told = message.substr(std::min(message.find("] ") + 2, message.size()));
    throw input_error_at(file, 0, std::string(told.substr(0, 100)));
  }
}

void require_version(const std::filesystem::path& file, const json& root) {
  const json& asset = root.at("asset");
  const std::string version = asset.at("version").get<std::string>();
  if (!version.starts_with("2."))
    throw input_error_at(file, 0, fmt::format("asset.version: {}", in_quotes(version)),
                         "only glTF 2 is read");
}

}  // namespace

std::shared_ptr<const json> parse_gltf(const std::filesystem::path& file, const GltfParts& parts) {
  auto root = std::make_shared<const json>(parse_json(file, parts));
  if (!root->is_object()) throw input_error_at(file, 0, "the JSON is no object", "is this a glTF file?");
  check_gltf_schema(file, *root);
  require_version(file, *root);
  return root;
}

}  // namespace fluxel

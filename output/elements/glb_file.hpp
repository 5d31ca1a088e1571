#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace fluxel {

/// Constants of glTF 2.0: types of numbers, and what a view of the buffer is for.
inline constexpr int kGltfUnsignedShort = 5123, kGltfUnsignedInt = 5125, kGltfFloat = 5126,
                     kGltfVertices = 34962, kGltfIndices = 34963;

/// The buffer of a binary glTF file, and what its parts are.
class GlbBuffer {
 public:
  /// Adds values that lie one after the other, with `stride` with a rest behind each, and returns the number
  /// of their accessor.
  template <class T>
  std::size_t add(const std::vector<T>& values, int target, nlohmann::json accessor, bool stride = false) {
    const std::size_t view =
        add_bytes({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    views_[view]["target"] = target;
    if (stride) views_[view]["byteStride"] = sizeof(T);
    accessor["bufferView"] = view;
    accessor["count"] = values.size();
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }
  /// The same with the least and the largest coordinates, which the format wants of positions [m].
  std::size_t add_positions(const std::vector<glm::vec3>& positions);
  /// Three a triangle.
  std::size_t add_indices(const std::vector<std::uint32_t>& corners);

  /// Any bytes, as those of a picture; returns the number of the view.
  std::size_t add_bytes(std::string_view bytes);

  void describe(nlohmann::json& document) const;
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  nlohmann::json views_ = nlohmann::json::array(), accessors_ = nlohmann::json::array();
};

[[nodiscard]] nlohmann::json vector_json(const glm::vec3& v);

/// What all files say.
struct GlbScene {
  glm::dvec3 origin{0};  ///< that positions are from [m]
  bool z_up = false;     ///< the scene is then turned to y up
  std::string generator;
  std::string comment;  ///< of the asset; may be empty
};

/// That shows its colours as they are (KHR_materials_unlit).
[[nodiscard]] nlohmann::json unlit_material(const std::string& name);

/// With the nodes below one root, which turns and moves the scene.
[[nodiscard]] nlohmann::json document_of(const GlbScene& scene, const nlohmann::json& nodes,
                                         const nlohmann::json& meshes, const nlohmann::json& materials);

/// Writes one binary file of glTF 2.0: what `document` says beside the buffer, and the buffer. Throws
/// InputError where it cannot be written (nothing then stands under its name) and where it would be longer
/// than the 4 GiB that the format allows.
void write_glb_file(const std::filesystem::path& file, nlohmann::json document, const GlbBuffer& buffer);

}  // namespace fluxel

// A glTF text or a GLB and, after a line `%%`, the bytes of each other file that it names: read and made into
// patches.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "scene/readers/gltf_reader.hpp"
#include "scene/to_patches.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::string separator = "\n%%\n";
  const std::size_t split = input.find(separator);
  const std::string other = split == std::string::npos ? "" : input.substr(split + separator.size());
  const auto lookup = [&](const std::filesystem::path&) { return std::optional(other); };
  try {
    const fluxel::SceneInput scene = fluxel::read_gltf("scene.gltf", input.substr(0, split), lookup);
    static_cast<void>(fluxel::to_patches(scene, {}));
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

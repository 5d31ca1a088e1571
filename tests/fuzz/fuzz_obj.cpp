// An OBJ text and, after a line `%%`, the text of the material file `m.mtl`: read and made into patches.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "scene/readers/obj_reader.hpp"
#include "scene/to_patches.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::string separator = "\n%%\n";
  const std::size_t split = input.find(separator);
  const std::string obj = input.substr(0, split);
  const std::string mtl = split == std::string::npos ? "" : input.substr(split + separator.size());
  const auto lookup = [&](const std::filesystem::path& path) {
    return path == "m.mtl" ? std::optional(mtl) : std::nullopt;
  };
  try {
    const fluxel::SceneInput scene = fluxel::read_obj_text("scene.obj", obj, lookup);
    static_cast<void>(fluxel::to_patches(scene, {}));
    fluxel::SceneSettings thermal;
    thermal.thermal = true;
    static_cast<void>(fluxel::to_patches(scene, thermal));
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

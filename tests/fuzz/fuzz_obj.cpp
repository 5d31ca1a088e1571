// An OBJ text; after a line `%%` the text of the material file `m.mtl`, and after another the bytes of its
// image `i.png`: read and made into patches.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "scene/readers/obj_reader.hpp"
#include "scene/to_patches.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string rest(reinterpret_cast<const char*>(data), size);
  const auto take_part = [&rest] {
    const std::string separator = "\n%%\n";
    const std::size_t split = rest.find(separator);
    const std::string part = rest.substr(0, split);
    rest = split == std::string::npos ? "" : rest.substr(split + separator.size());
    return part;
  };
  const std::string obj = take_part(), mtl = take_part(), image = rest;
  const auto lookup = [&](const std::filesystem::path& path) {
    return path == "m.mtl" ? std::optional(mtl) : path == "i.png" ? std::optional(image) : std::nullopt;
  };
  try {
    const fluxel::SceneInput scene = fluxel::read_obj_text("scene.obj", obj, lookup);
    static_cast<void>(fluxel::to_patches(scene, {}));
    fluxel::SceneSettings thermal;
    thermal.thermal = true;
    static_cast<void>(fluxel::to_patches(scene, thermal));
    fluxel::SceneSettings by_face;
    by_face.textures = fluxel::Textures::face;
    static_cast<void>(fluxel::to_patches(scene, by_face));
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

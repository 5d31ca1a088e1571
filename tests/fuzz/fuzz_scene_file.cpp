// The text of a scene file; every geometry file is the same small one, as is every photometric file.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "scene/readers/scene_file.hpp"
#include "scene/to_patches.hpp"

namespace {

constexpr const char* kObj =
    "mtllib box.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
    "g floor\nusemtl white\nf 1 2 3 4\n"
    "g lamp\nusemtl light\nf 1 2 5\n";
constexpr const char* kMtl = "newmtl white\nKd 0.5 0.5 0.5\nnewmtl light\nKd 0 0 0\nKe 1 1 1\n";
constexpr const char* kIes = "TILT=NONE\n1 -1 1 2 1 1 2 0.3 1.2 0 1 1 50 0 180 0 100 100\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto lookup = [](const std::filesystem::path& path) {
    const auto extension = path.extension();
    return std::optional<std::string>(extension == ".mtl" ? kMtl : extension == ".ies" ? kIes : kObj);
  };
  try {
    const fluxel::SceneInput scene = fluxel::read_scene_text("scene.toml", text, lookup);
    static_cast<void>(fluxel::to_patches(scene, {}));
    fluxel::SceneSettings thermal;
    thermal.thermal = true;
    static_cast<void>(fluxel::to_patches(scene, thermal));
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

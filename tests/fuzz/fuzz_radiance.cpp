// A Radiance scene description: read and made into patches.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "scene/readers/radiance_reader.hpp"
#include "scene/to_patches.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const auto lookup = [](const std::filesystem::path&) { return std::optional<std::string>(); };
  try {
    const fluxel::SceneInput scene = fluxel::read_radiance("scene.rad", bytes, lookup);
    static_cast<void>(fluxel::to_patches(scene, {}));
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

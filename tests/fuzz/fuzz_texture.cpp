// The bytes of an image, PNG or JPEG: decoded, and its means taken over polygons made of the same bytes.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <glm/vec2.hpp>
#include <string>

#include "core/error.hpp"
#include "scene/readers/texture.hpp"

namespace {

void require_reflectance(const fluxel::Rgb& rho) {
  for (int c = 0; c < fluxel::kChannels; ++c)
    if (!(rho[c] >= 0 && rho[c] <= 1 + 1e-9)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  std::array<glm::dvec2, 4> any{};  // from the last bytes, which decoders do not look at
  if (size >= sizeof any) std::memcpy(any.data(), data + size - sizeof any, sizeof any);
  const std::array<glm::dvec2, 3> triangle{glm::dvec2(-0.3, 0.1), {1.7, 0.4}, {0.2, 2.5}};
  try {
    const fluxel::Texture texture = fluxel::Texture::decode("a.png", bytes);
    require_reflectance(texture.mean());
    require_reflectance(texture.mean_over(any));
    require_reflectance(texture.mean_over(triangle));
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

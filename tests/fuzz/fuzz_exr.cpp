// The bytes of an OpenEXR picture. What is read is consistent.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.hpp"
#include "image/exr_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    const fluxel::LayeredImage image = fluxel::exr_of_bytes("image.exr", bytes);
    if (image.pixels() == 0 || !image.layers.contains("")) std::abort();
    for (const auto& [name, values] : image.layers)
      if (values.size() != image.pixels()) std::abort();
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

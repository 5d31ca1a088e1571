// The text of a camera's JSON file.
#include <cstddef>
#include <cstdint>
#include <string>

#include "app/camera_file.hpp"
#include "core/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    static_cast<void>(
        fluxel::read_camera_text("eye.json", std::string(reinterpret_cast<const char*>(data), size)));
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

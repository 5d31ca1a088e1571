// The bytes of a file of elements: solution.ply or reference.ply. What is read is consistent.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.hpp"
#include "output/elements/element_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const fluxel::ElementFile file = fluxel::element_file_of_bytes("solution.ply", bytes);
    const std::size_t elements = file.elements.outlines.size();
    if (elements == 0 || file.elements.patches.size() != elements || file.layers.empty()) std::abort();
    for (const auto& [name, values] : file.layers)
      if (values.size() != elements) std::abort();
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}

// The bytes of a solution.ply that a run is to start from, for two elements.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/error.hpp"
#include "scene/solution_writer.hpp"

namespace {

fluxel::ElementMesh two_elements() {
  fluxel::ElementMesh mesh;
  mesh.outlines.resize(2);
  mesh.outlines[0] = {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 4};
  mesh.outlines[1] = {{{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}}, 3};
  mesh.elements.resize(2);
  for (fluxel::Element& element : mesh.elements) element.patch = fluxel::PatchId{7};
  return mesh;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fluxel::ElementMesh mesh = two_elements();
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  for (const bool two_sided : {false, true}) {
    try {
      static_cast<void>(fluxel::solution_of_bytes("solution.ply", bytes, {}, mesh, two_sided));
    } catch (const fluxel::InputError&) {  // how bad input is to be told
    }
  }
  return 0;
}

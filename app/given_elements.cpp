#include "app/given_elements.hpp"

#include <span>
#include <utility>

#include "mpi_master/communication/agreement.hpp"
#include "output/elements/reference_elements.hpp"

namespace fluxel {

GivenElements read_given_elements(const Communicator& world, const std::string& file, const Scene& scene) {
  GivenElements given;
  on_root(world, [&] {
    if (file.empty()) return;
    ElementFile read = read_element_file(file);
    given.shapes = shapes_on_scene(file, read, scene);
    given.of_file = std::move(read.elements);
  });
  given.shapes = world.all_gather(std::span<const ElementShape>(given.shapes));
  return given;
}

}  // namespace fluxel

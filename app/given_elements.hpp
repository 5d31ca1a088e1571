#pragma once

#include <string>
#include <vector>

#include "mpi_master/communication/communicator.hpp"
#include "output/elements/element_file.hpp"
#include "reference/sensors.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Elements of a file that are to be measured.
struct GivenElements {
  FileElements of_file;              ///< on the root alone
  std::vector<ElementShape> shapes;  ///< on all ranks
};

/// Collective: throws AgreedError where the file cannot be read or its elements are not of the scene. An
/// empty name: none.
[[nodiscard]] GivenElements read_given_elements(const Communicator& world, const std::string& file,
                                                const Scene& scene);

}  // namespace fluxel

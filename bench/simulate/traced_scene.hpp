#pragma once

#include <string>
#include <vector>

#include "bench/simulate/tile_map.hpp"
#include "mpi_master/scheduling/tile_sample.hpp"

namespace fluxel::bench {

/// A scene as the simulation knows it.
struct TracedScene {
  std::string name;
  std::size_t elements = 0;
  std::vector<std::size_t> first_element;  ///< of each patch that has elements, and the end
  RowCosts costs;                          ///< the forecast's
  TileMap map;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(name, elements, first_element, costs.trace, costs.solve, costs.bytes, map);
  }
};

/// Throw InputError for a file that cannot be written, or read as such.
void write_traced_scene(const std::string& file, const TracedScene& scene);
[[nodiscard]] TracedScene read_traced_scene(const std::string& file);

}  // namespace fluxel::bench

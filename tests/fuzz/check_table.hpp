#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "scene/intensity_table.hpp"

namespace fluxel {

/// Ends the program where a table breaks its promises.
inline void check_table(const IntensityTable& table) {
  const auto require = [](bool kept) {
    if (!kept) std::abort();
  };
  require(table.gamma.size() >= 2 && table.gamma.front() >= 0 && table.gamma.back() <= std::numbers::pi);
  require(table.C.front() == 0 && (table.C.size() == 1 || table.C.back() == 2 * std::numbers::pi));
  require(table.intensity.size() == table.C.size() * table.gamma.size());
  require(flux(table) > 0 && std::isfinite(flux(table)));
  const double most = largest_intensity(table) * (1 + 1e-12);
  for (double C = -1; C < 8; C += 0.7) {
    for (const double gamma : {0.0, 0.1, 1.5, table.gamma[0], table.gamma.back(), std::numbers::pi}) {
      const double here = intensity(table, C, gamma);
      require(here >= 0 && here <= most);
    }
  }
}

}  // namespace fluxel

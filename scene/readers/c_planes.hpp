#pragma once

#include <string>
#include <vector>

#include "scene/intensity_table.hpp"

namespace fluxel {

/// The intensities of a C plane, one for each gamma.
struct CPlane {
  double C = 0;  ///< [degrees]
  std::vector<double> intensity;
};

/// Adds to ascending planes their mirror images about the last, so that they reach as far on the other side.
void mirror_planes(std::vector<CPlane>& planes);

/// The table of planes that ascend through a whole turn at most, from anywhere (a C beyond 360 degrees goes
/// on from 0); of a single plane the table that is the same for all C. What lies between the last plane and
/// the first is interpolated. `gamma` ascends [degrees].
[[nodiscard]] IntensityTable make_intensity_table(std::vector<CPlane> planes,
                                                  const std::vector<double>& gamma);

/// Where `gamma` [degrees] begins or ends elsewhere than at 0, 90 or 180 degrees: no light goes beyond.
void note_dark_angles(const std::vector<double>& gamma, std::vector<std::string>& notes);

}  // namespace fluxel

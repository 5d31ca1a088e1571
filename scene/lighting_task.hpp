#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fluxel {

/// What a standard asks of the light of a place of work (EN 12464-1). Illuminances are maintained ones.
struct LightingTask {
  std::string name;
  std::string area;                    ///< the receiver of the task area
  std::string surrounding;             ///< that of the immediate surrounding area; empty: none
  std::string background;              ///< that of the background area; empty: none
  double illuminance = 0;              ///< least mean of the task area [lx]
  std::optional<double> U0;            ///< least uniformity of the task area
  std::optional<double> UGR;           ///< largest unified glare rating
  std::vector<std::string> observers;  ///< to whom the rating applies
};

}  // namespace fluxel

#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/rgb.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Makes materials of the reflectances of faces, one for all that agree in 8 bits of sRGB: of a scan with a
/// colour for each face there are far fewer than faces.
class ColourBins {
 public:
  /// The material of a face of reflectance `rho`, 0..1.
  [[nodiscard]] MaterialId add(const Rgb& rho);

  /// `colour R G B` each, whose reflectance is the mean over its faces.
  [[nodiscard]] std::vector<InputMaterial> materials() const;

 private:
  struct Bin {
    std::uint32_t srgb;  ///< 8 bits a channel
    Rgb sum;
    double faces;
  };

  std::vector<Bin> bins_;
  std::unordered_map<std::uint32_t, MaterialId> ids_;  // by srgb
};

}  // namespace fluxel

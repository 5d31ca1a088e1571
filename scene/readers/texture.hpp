#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// An image of reflectances in linear light, which repeats over the plane of texture coordinates.
class Texture {
 public:
  /// Decodes a PNG or a JPEG file, told apart by its first bytes; 8-bit values are sRGB. Throws InputError
  /// with `file` for other data, damaged data and more than 16384 x 16384 pixels.
  [[nodiscard]] static Texture decode(const std::filesystem::path& file, const std::string& bytes);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Some pixel is transparent.
  [[nodiscard]] bool has_alpha() const { return has_alpha_; }

  [[nodiscard]] Rgb mean() const;

  /// The mean over a polygon of texture coordinates, (0, 0) at the image's lower left corner as in OBJ files,
  /// of which each pixel covers its own square; over a polygon without an area, the pixel at its first
  /// corner.
  [[nodiscard]] Rgb mean_over(std::span<const glm::dvec2> corners) const;

 private:
  int width_ = 0, height_ = 0;
  bool has_alpha_ = false;
  std::vector<float> texels_;  ///< r, g, b of each pixel, rows from the top
};

}  // namespace fluxel

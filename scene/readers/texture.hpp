#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/rgb.hpp"
#include "scene/readers/decoded_image.hpp"

namespace fluxel {

/// An image of reflectances in linear light, which repeats over the plane of texture coordinates. What is
/// transparent counts by its colour.
class Texture {
 public:
  /// The first bytes are those of a format that `decode` knows.
  [[nodiscard]] static bool is_known(const std::string& bytes) { return is_png(bytes) || is_jpeg(bytes); }

  /// Decodes a PNG or a JPEG file, told apart by its first bytes; values of 8 and of 16 bits are taken as
  /// coded by sRGB (IEC 61966-2-1), whatever gamma or profile the file names. Throws InputError with `file`
  /// for other data, damaged data, CMYK, more than 16384 pixels along an edge and more than 2^26 in all.
  [[nodiscard]] static Texture decode(const std::filesystem::path& file, const std::string& bytes);

  [[nodiscard]] int width() const { return image_.width; }
  [[nodiscard]] int height() const { return image_.height; }
  /// Some pixel is transparent.
  [[nodiscard]] bool has_alpha() const { return has_alpha_; }

  [[nodiscard]] Rgb mean() const { return mean_; }

  /// The mean over a simple polygon of texture coordinates, (0, 0) at the image's lower left corner as in OBJ
  /// files, of which each pixel covers its own square: exact, by Green's theorem along the outline. Where the
  /// outline crosses more than 2^20 pixels (an image of 1024 x 1024 some 256 times along each edge of a
  /// square), the mean of the image, and over no corners. Over a polygon without an area, the pixel at its
  /// first corner.
  [[nodiscard]] Rgb mean_over(std::span<const glm::dvec2> corners) const;

 private:
  explicit Texture(DecodedImage image);

  [[nodiscard]] Rgb pixel(int row, int column) const;
  [[nodiscard]] Rgb sum_of_row(int row, int columns) const;
  [[nodiscard]] Rgb sum_to(int row, double x) const;
  [[nodiscard]] Rgb mean_sum(int row, double from, double to) const;
  [[nodiscard]] Rgb integral_along(glm::dvec2 from, glm::dvec2 to) const;

  DecodedImage image_;
  bool has_alpha_ = false;
  std::size_t blocks_ = 0;  ///< sums kept of a row
  std::vector<Rgb> sums_;   ///< of each row, over all pixels left of its 0th, 16th, 32nd ...
  Rgb mean_{0};
};

}  // namespace fluxel

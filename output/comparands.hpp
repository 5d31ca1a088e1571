#pragma once

#include <string>
#include <vector>

#include "metrics/field_errors.hpp"
#include "output/elements/element_file.hpp"

namespace fluxel {

/// A field with its values.
struct FieldData {
  std::vector<Rgb> values;
  /// Empty where the file states no noise; where it has no error of each value that of its halves.
  std::vector<Rgb> error, half_a, half_b;

  [[nodiscard]] Field field() const { return {values, error, half_a, half_b}; }
};

/// What two files say of the same elements, or of the same pixels.
struct Comparands {
  FieldData judged, reference;
  std::vector<double> weights;  ///< of elements' sides their area [m2], 0 where both are dark; 1 a pixel
  FileElements elements;        ///< none of pixels; the values are those of their fronts, then of backs
  int width = 0, height = 0;    ///< of pixels

  [[nodiscard]] bool of_elements() const { return width == 0; }
  [[nodiscard]] std::size_t sides() const;  ///< that count
  [[nodiscard]] double area() const;        ///< of these [m2]
};

/// Reads A and B: two files of elements (.ply), or two pictures or receivers (.exr). Throws InputError for a
/// file that cannot be read, is of another kind or size than the other one or lacks what is compared, for
/// elements that are not the same to within a millionth of the scene or dark in both, and for noise layers
/// that are incomplete.
[[nodiscard]] Comparands read_comparands(const std::string& judged, const std::string& reference);

}  // namespace fluxel

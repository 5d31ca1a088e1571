#include "output/false_colour_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/luminance.hpp"
#include "core/options.hpp"
#include "core/thermal.hpp"
#include "image/png_writer.hpp"
#include "image/value_map.hpp"
#include "output/outcome.hpp"

namespace fluxel {

namespace {

/// Of the elements that pixels show; not a number where they show none, or a side that is no unknown.
std::vector<double> temperatures(const Picture& picture, const RunRecord& record) {
  const ElementView& mesh = record.solution.subdivided.mesh;
  std::vector<double> values(picture.pixels(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (picture.element[k] == kNoElement) continue;
    const std::size_t i = index(picture.element[k]);
    const Element& element = mesh.elements[i];
    const bool is_front = glm::dot(picture.normal[k], element.normal) > 0;
    if ((element.sides & (is_front ? kFront : kBack)) == 0) continue;
    const std::size_t unknown = is_front ? i : i + mesh.elements.size();
    const ThermalSurface& surface = *record.scene.materials[index(element.material)].thermal;
    const double kelvin = temperature_of(black_exitance(surface, record.solution.radiosity->H[unknown].r));
    values[k] = in_unit(kelvin, record.scene.temperature_unit);
  }
  return values;
}

std::vector<double> luminances(const Picture& picture) {
  std::vector<double> values;
  values.reserve(picture.pixels());
  for (const Rgb& radiance : picture.radiance) values.push_back(luminance(radiance));
  return values;
}

/// Of each pixel whether it shows the front of a lamp.
std::vector<bool> pixels_of_emitters(const Picture& picture, const RunRecord& record) {
  const ElementView& mesh = record.solution.subdivided.mesh;
  std::vector<bool> found(picture.pixels());
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (picture.element[k] == kNoElement) continue;
    const Element& element = mesh.elements[index(picture.element[k])];
    found[k] = glm::dot(picture.normal[k], element.normal) > 0 &&
               record.scene.materials[index(element.material)].emits();
  }
  return found;
}

/// What the scale is chosen by: of light not the lamps, beside which all else would be dark, nor the pixels
/// around them, which show some of them; but all where nothing else is seen.
std::vector<double> without_emitters(const std::vector<double>& values, const Picture& picture,
                                     const RunRecord& record) {
  const std::vector<bool> emitters = pixels_of_emitters(picture, record);
  std::vector<double> others;
  const int width = picture.width, height = picture.height;
  const auto emits = [&](int row, int column) {
    return row >= 0 && row < height && column >= 0 && column < width &&
           emitters[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(column)];
  };
  double most = 0;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      bool near = false;
      for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u) near = near || emits(row + v, column + u);
      if (near) continue;
      others.push_back(values[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(column)]);
      most = std::max(most, others.back());
    }
  }
  return most > 0 ? others : values;
}

}  // namespace

DisplayPicture false_colour_picture(const OutputSource& source) {
  const RunRecord& record = source.record;
  const Picture& picture = source.picture->picture;
  const bool is_heat = record.options.thermal;
  ValueMap map;
  map.columns = picture.width;
  map.rows = picture.height;
  map.values = is_heat ? temperatures(picture, record) : luminances(picture);
  map.title = fmt::format("{}: {}", record.scene.name, is_heat ? "temperature" : "radiance");
  map.unit = is_heat ? symbol_of(record.scene.temperature_unit) : unit_names(record.scene.units).radiance;
  if (std::string what = unreached(record); !what.empty()) map.lines = {std::move(what)};
  // Temperatures lie far from 0 K, and 0 C is no end of any scale.
  const ScaleStart start = is_heat ? ScaleStart::least : ScaleStart::zero;
  const std::vector<double> scaled_by = is_heat ? map.values : without_emitters(map.values, picture, record);
  return draw_value_map(map, choose_scale(scaled_by, record.options.false_colour, start));
}

void write_false_colour_picture(const std::filesystem::path& file, const OutputSource& source) {
  write_png(file, false_colour_picture(source));
}

}  // namespace fluxel

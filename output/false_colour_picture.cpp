#include "output/false_colour_picture.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

#include "core/luminance.hpp"
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
  return draw_value_map(map, choose_scale(map.values, record.options.false_colour, start));
}

void write_false_colour_picture(const std::filesystem::path& file, const OutputSource& source) {
  write_png(file, false_colour_picture(source));
}

}  // namespace fluxel

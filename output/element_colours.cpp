#include "output/element_colours.hpp"

#include <numbers>

#include "core/options.hpp"
#include "core/srgb.hpp"

namespace fluxel {

namespace {

/// The unknown of an element that is shown.
std::size_t shown_side(const ElementView& mesh, std::size_t element) {
  return (mesh.elements[element].sides & kFront) != 0 ? element : element + mesh.elements.size();
}

}  // namespace

ToneCurve curve_of_elements(const OutputSource& source) {
  if (source.picture) return source.picture->display.curve;
  const RunRecord& record = source.record;
  const ElementView& mesh = record.solution.subdivided.mesh;
  Picture elements;
  elements.width = static_cast<int>(mesh.elements.size());
  elements.height = 1;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const std::size_t side = shown_side(mesh, i);
    elements.radiance.push_back(record.solution.radiosity->B[side] / std::numbers::pi);
    elements.irradiance.push_back(record.solution.radiosity->H[side]);
    elements.reflectance.push_back(record.scene.materials[index(mesh.elements[i].material)].rho);
  }
  return choose_curve(elements, record.options.exposure, record.options.tone);
}

std::vector<std::uint8_t> colours_of_elements(const OutputSource& source) {
  const ToneCurve curve = curve_of_elements(source);
  const ElementView& mesh = source.record.solution.subdivided.mesh;
  std::vector<std::uint8_t> rgb;
  rgb.reserve(kChannels * mesh.elements.size());
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    const Rgb colour =
        curve.shown(source.record.solution.radiosity->B[shown_side(mesh, i)] / std::numbers::pi);
    for (int c = 0; c < kChannels; ++c) rgb.push_back(encode_srgb(colour[c]));
  }
  return rgb;
}

}  // namespace fluxel

#include "output/light_map_files.hpp"

#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/srgb.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "output/element_colours.hpp"
#include "output/elements/textured_glb.hpp"
#include "output/glb_parts.hpp"
#include "output/surface_error.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

/// What a chart's piece sends for what falls on it.
struct ChartMaterial {
  Rgb E{0}, rho{0};
};

ChartMaterial material_of(const Scene& scene, const LightMapChart& chart) {
  const Material& material = scene.material(scene.patch(scene.pieces[chart.piece].patch));
  return {chart.front ? material.E : material.back_exitance(), material.rho};
}

/// Of each texel [W/m2/sr]; 0 where there is no chart.
struct TexelRadiance {
  std::vector<Rgb> radiance, noise;
};

TexelRadiance radiance_of(const Scene& scene, const LightMap& map) {
  TexelRadiance found{std::vector<Rgb>(map.H.size(), Rgb(0)), std::vector<Rgb>(map.H.size(), Rgb(0))};
  for (std::size_t texel = 0; texel < map.H.size(); ++texel) {
    if (map.chart[texel] == LightMap::kNone) continue;
    const ChartMaterial of = material_of(scene, map.layout.charts[map.chart[texel]]);
    found.radiance[texel] = (of.E + of.rho * map.H[texel]) / std::numbers::pi;
    found.noise[texel] = of.rho * map.noise_of_H[texel] / std::numbers::pi;
  }
  return found;
}

void add_chart(const Scene& scene, const LightMapLayout& layout, const LightMapChart& chart,
               TexturedPart& part) {
  const TexelLattice& lattice = layout.lattices[chart.lattice];
  const Outline<glm::dvec3>& front = scene.pieces[chart.piece].outline;
  const Outline<glm::dvec3> outline = chart.front ? front : reversed(front);
  const auto first = static_cast<std::uint32_t>(part.positions.size());
  for (const glm::dvec3& corner : corners(outline)) {
    part.positions.emplace_back(corner);
    part.along_surface.emplace_back(lattice.along_axes(corner));
    part.in_texture.emplace_back(layout.place(chart, corner) / glm::dvec2(layout.width, layout.height));
  }
  for (std::uint32_t k = 2; k < outline.corners; ++k)
    part.corners.insert(part.corners.end(), {first, first + k - 1, first + k});
}

/// One for each group and material that occur together.
std::vector<TexturedPart> textured_parts(const Scene& scene, const LightMapLayout& layout) {
  std::map<std::pair<std::size_t, std::size_t>, TexturedPart> parts;
  for (const LightMapChart& chart : layout.charts) {
    const Patch& patch = scene.patch(scene.pieces[chart.piece].patch);
    TexturedPart& part = parts[{index(patch.group), index(patch.material)}];
    part.name = scene.groups[index(patch.group)];
    part.material = scene.materials[index(patch.material)].name;
    add_chart(scene, layout, chart, part);
  }
  std::vector<TexturedPart> in_order;
  in_order.reserve(parts.size());
  for (auto& [key, part] : parts) in_order.push_back(std::move(part));
  return in_order;
}

}  // namespace

void write_light_map_exr(const std::filesystem::path& file, const OutputSource& source,
                         const std::map<std::string, std::string>& attributes) {
  const LightMap& map = *source.record.solution.light_map;
  LayeredImage image{map.layout.width, map.layout.height, {}};
  TexelRadiance light = radiance_of(source.record.scene, map);
  if (const std::optional<Rgb> common = surface_error(source.record)) {
    std::vector<Rgb>& error = image.layers["error"];
    for (std::size_t texel = 0; texel < map.H.size(); ++texel)
      error.push_back(map.chart[texel] == LightMap::kNone
                          ? Rgb(0)
                          : error_with_noise(*common / std::numbers::pi, light.noise[texel]));
  }
  image.layers[""] = std::move(light.radiance);
  image.layers["noise"] = std::move(light.noise);
  image.layers["irradiance"] = map.H;
  image.layers["irradiance_noise"] = map.noise_of_H;
  write_exr(file, image, attributes);
}

std::string light_map_png(const OutputSource& source) {
  const LightMap& map = *source.record.solution.light_map;
  DisplayPicture picture;
  picture.width = map.layout.width;
  picture.height = map.layout.height;
  picture.curve = curve_of_elements(source);
  picture.rgb.reserve(kChannels * map.H.size());
  for (const Rgb& radiance : radiance_of(source.record.scene, map).radiance) {
    const Rgb colour = picture.curve.shown(radiance);
    for (int c = 0; c < kChannels; ++c) picture.rgb.push_back(encode_srgb(colour[c]));
  }
  return png_bytes(picture);
}

void write_light_map_glb(const std::filesystem::path& file, const OutputSource& source) {
  const RunRecord& record = source.record;
  write_textured_glb(file, textured_parts(record.scene, record.solution.light_map->layout),
                     source.light_map_png, glb_scene(record));
}

}  // namespace fluxel

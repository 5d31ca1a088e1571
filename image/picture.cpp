#include "image/picture.hpp"

#include <limits>
#include <numbers>
#include <stdexcept>

namespace fluxel {

namespace {

struct Shade {
  Rgb radiance{0.0}, reflectance{0.0}, irradiance{0.0};
};

void require_fitting_sizes(const Raster& fine, int supersample, const ElementView& mesh,
                           const SurfaceLight& light) {
  const bool whole_pixels =
      supersample >= 1 && fine.width % supersample == 0 && fine.height % supersample == 0;
  const bool whole_raster = fine.depth.size() == fine.pixels() && fine.element.size() == fine.pixels() &&
                            fine.front.size() == fine.pixels();
  const std::size_t elements = mesh.elements.size();
  const bool whole_front = light.B_front.size() == elements && light.H_front.size() == elements;
  const bool whole_back =
      light.B_back.size() == light.H_back.size() && (light.B_back.empty() || light.B_back.size() == elements);
  if (!whole_pixels || !whole_raster || !whole_front || !whole_back) {
    throw std::logic_error("make_picture: raster, elements and light do not fit each other");
  }
}

Shade shade(const Raster& fine, std::size_t pixel, const Scene& scene, const ElementView& mesh,
            const SurfaceLight& light, std::span<const Rgb> irradiance) {
  const ElementId id = fine.element[pixel];
  if (id == kNoElement) return {};
  const Element& element = mesh.elements[index(id)];
  const bool front = fine.front[pixel] != 0;
  if ((element.sides & (front ? kFront : kBack)) == 0) return {};
  const Material& material = scene.materials[index(element.material)];
  if (!irradiance.empty()) {
    const Rgb E = front ? material.E : material.back_exitance();
    return {(E + material.rho * irradiance[pixel]) / std::numbers::pi, material.rho, irradiance[pixel]};
  }
  const Rgb& B = front ? light.B_front[index(id)] : light.B_back.at(index(id));
  const Rgb& H = front ? light.H_front[index(id)] : light.H_back.at(index(id));
  return {B / std::numbers::pi, material.rho, H};
}

}  // namespace

Picture make_picture(const Raster& fine, int supersample, const Scene& scene, const ElementView& mesh,
                     const SurfaceLight& light, std::span<const Rgb> irradiance,
                     std::span<const EdgePixel> edges) {
  require_fitting_sizes(fine, supersample, mesh, light);
  if (!irradiance.empty() && irradiance.size() != fine.pixels())
    throw std::logic_error("make_picture: irradiance and raster do not fit each other");
  Picture picture;
  picture.width = fine.width / supersample;
  picture.height = fine.height / supersample;
  const std::size_t pixels = picture.pixels();
  picture.radiance.assign(pixels, Rgb(0.0));
  picture.element.assign(pixels, kNoElement);
  picture.depth.assign(pixels, std::numeric_limits<float>::infinity());
  picture.normal.assign(pixels, glm::vec3(0));
  picture.reflectance.assign(pixels, Rgb(0.0));
  picture.irradiance.assign(pixels, Rgb(0.0));

  const auto fine_width = static_cast<std::size_t>(fine.width);
  const auto k = static_cast<std::size_t>(supersample);
  const double weight = 1.0 / static_cast<double>(k * k);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const std::size_t row = pixel / static_cast<std::size_t>(picture.width);
    const std::size_t column = pixel % static_cast<std::size_t>(picture.width);
    Shade sum;
    for (std::size_t y = row * k; y < (row + 1) * k; ++y) {
      for (std::size_t x = column * k; x < (column + 1) * k; ++x) {
        const Shade seen = shade(fine, y * fine_width + x, scene, mesh, light, irradiance);
        sum.radiance += seen.radiance;
        sum.reflectance += seen.reflectance;
        sum.irradiance += seen.irradiance;
      }
    }
    picture.radiance[pixel] = sum.radiance * weight;
    picture.reflectance[pixel] = sum.reflectance * weight;
    picture.irradiance[pixel] = sum.irradiance * weight;

    const std::size_t centre = (row * k + k / 2) * fine_width + column * k + k / 2;
    const ElementId id = fine.element[centre];
    picture.element[pixel] = id;
    picture.depth[pixel] = static_cast<float>(fine.depth[centre]);
    if (id != kNoElement) {
      const glm::vec3 normal = mesh.elements[index(id)].normal;
      picture.normal[pixel] = fine.front[centre] != 0 ? normal : -normal;
    }
  }
  for (const EdgePixel& edge : edges) {
    picture.radiance.at(edge.pixel) = edge.exitance / std::numbers::pi;
    picture.reflectance[edge.pixel] = edge.reflectance;
    picture.irradiance[edge.pixel] = edge.irradiance;
  }
  return picture;
}

}  // namespace fluxel

#include "scene/readers/gltf_textures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <utility>

#include "scene/readers/gltf_uri.hpp"
#include "scene/readers/texture.hpp"

namespace fluxel {
namespace {

constexpr double kMostRepeats = 1e6;  // how often an image may repeat

using ImageTriangle = std::array<glm::dvec2, 3>;  // of a triangle in the image

/// A mean by weights.
struct WeightedMean {
  Rgb sum{0};
  double weight = 0;

  void add(const Rgb& value, double by) {
    sum += by * value;
    weight += by;
  }
  [[nodiscard]] Rgb value_or(const Rgb& otherwise) const { return weight > 0 ? sum / weight : otherwise; }
};

Texture read_image(const GltfFile& gltf, std::size_t image, const TextLookup& lookup) {
  const GltfValue given = gltf["images"][image], view = given["bufferView"], uri = given["uri"];
  const std::string where = gltf_element("images", image);
  if (view.given()) {
    const std::string_view bytes = buffer_view_bytes(gltf, view.whole());
    return Texture::decode(gltf.path.string() + ": " + where, std::string(bytes));
  }
  if (!uri.given()) throw gltf.error(where, "has neither uri nor bufferView");
  const std::string bytes = read_gltf_uri(gltf.path, where + ".uri", uri.text(), lookup);
  const bool embedded = uri.text().starts_with("data:");
  return Texture::decode(gltf.path.string() + ": " + (embedded ? where : std::string(uri.text())), bytes);
}

/// The places of vertices in an image whose v goes up, as Texture has it.
class ImagePlaces {
 public:
  ImagePlaces(const GltfFile& gltf, const GltfTriangles& triangles, const GltfTextureUse& use)
      : gltf_(gltf), triangles_(triangles), use_(use) {
    const GltfValue primitive = gltf["meshes"][triangles.mesh]["primitives"][triangles.primitive];
    const GltfValue accessor = primitive["attributes"][use.coordinates];
    if (!accessor.given()) return;
    coordinates_.emplace(gltf, accessor.whole(), 2);
    if (coordinates_->size() != triangles.positions.size())
      throw gltf.error(triangles.where(), fmt::format("{} and POSITION differ in length", use.coordinates));
  }

  [[nodiscard]] bool known() const { return coordinates_.has_value(); }

  [[nodiscard]] ImageTriangle of(std::size_t triangle) const {
    ImageTriangle places{};
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec4 given = (*coordinates_)[triangles_.corners[triangle][k]];
      const glm::dvec2 place = use_.linear * glm::dvec2(given) + use_.offset;
      if (!(std::abs(place.x) <= kMostRepeats && std::abs(place.y) <= kMostRepeats)) {
        throw gltf_.error(triangles_.where(),
                          fmt::format("{} is not a finite number up to {}", use_.coordinates, kMostRepeats));
      }
      places[k] = {place.x, 1 - place.y};
    }
    return places;
  }

 private:
  const GltfFile& gltf_;
  const GltfTriangles& triangles_;
  const GltfTextureUse& use_;
  std::optional<GltfAccessor> coordinates_;
};

double area_of(const ImageTriangle& corners) {
  const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
  return std::abs(a.x * b.y - a.y * b.x) / 2;
}

/// Calls `visit` with the index of a triangle, its mean over the image and its area in it.
template <class Visit>
void visit_means(const GltfFile& gltf, const GltfTriangles& triangles, const GltfTextureUse& use,
                 const Texture& image, const Visit& visit) {
  const ImagePlaces places(gltf, triangles, use);
  const Rgb mean = image.mean();
  for (std::size_t t = 0; t < triangles.corners.size(); ++t) {
    if (!places.known()) {
      visit(t, mean, 0.0);
      continue;
    }
    const ImageTriangle corners = places.of(t);
    visit(t, image.mean_over(corners), area_of(corners));
  }
}

/// Calls `visit` with the triangles of each mesh, and how often they stand in the scene.
template <class Visit>
void visit_triangles(GltfMeshes& meshes, std::size_t material, const Visit& visit) {
  for (std::size_t mesh = 0; mesh < meshes.meshes.size(); ++mesh) {
    for (GltfTriangles& triangles : meshes.meshes[mesh]) {
      if (triangles.material == material) visit(triangles, static_cast<double>(meshes.copies[mesh]));
    }
  }
}

void apply_base_colour(const GltfFile& gltf, const Texture& image, GltfMeshes& meshes, std::size_t k,
                       GltfMaterial& material) {
  const Rgb factor = material.input.rho;
  visit_triangles(meshes, k, [&](GltfTriangles& triangles, double) {
    triangles.rho.resize(triangles.corners.size());
    visit_means(gltf, triangles, *material.base_colour, image,
                [&](std::size_t t, const Rgb& mean, double) { triangles.rho[t] = factor * mean; });
  });
  // Until its faces are placed, whose areas the mean is over (face_materials.hpp).
  material.input.rho = factor * image.mean();
  material.input.textured = true;
}

void apply_emission(const GltfFile& gltf, const Texture& image, GltfMeshes& meshes, std::size_t k,
                    GltfMaterial& material) {
  WeightedMean all;
  visit_triangles(meshes, k, [&](const GltfTriangles& triangles, double copies) {
    visit_means(gltf, triangles, *material.emission, image,
                [&](std::size_t, const Rgb& mean, double area) { all.add(mean, area * copies); });
  });
  *material.input.E *= all.value_or(image.mean());
}

}  // namespace

void apply_gltf_textures(const GltfFile& gltf, const TextLookup& lookup, GltfMeshes& meshes,
                         std::vector<GltfMaterial>& materials) {
  struct Users {
    std::vector<std::size_t> base_colour, emission;
  };
  std::map<std::size_t, Users> of_image;
  for (std::size_t k = 0; k < materials.size(); ++k) {
    if (materials[k].base_colour) of_image[materials[k].base_colour->image].base_colour.push_back(k);
    if (materials[k].emission) of_image[materials[k].emission->image].emission.push_back(k);
  }
  for (const auto& [image, users] : of_image) {
    const Texture texture = read_image(gltf, image, lookup);
    for (const std::size_t k : users.base_colour) apply_base_colour(gltf, texture, meshes, k, materials[k]);
    for (const std::size_t k : users.emission) apply_emission(gltf, texture, meshes, k, materials[k]);
  }
}

}  // namespace fluxel

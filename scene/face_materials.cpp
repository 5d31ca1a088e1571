#include "scene/face_materials.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <utility>

#include "scene/polygon.hpp"

namespace fluxel {
namespace {

constexpr double kStep = 0.02;            // of reflectance
constexpr double kLeastFaceShare = 1e-4;  // of the area of all faces

/// The mean over faces by their areas.
struct AreaMean {
  Rgb sum{0};
  double area = 0;

  void add(const Rgb& rho, double face_area) {
    sum += face_area * rho;
    area += face_area;
  }
  [[nodiscard]] Rgb mean() const { return glm::min(sum / area, Rgb(1)); }
};

/// Number of the step around the mean, in each channel.
std::array<int, kChannels> step_of(const Rgb& rho, const Rgb& mean) {
  const Rgb steps = glm::round((rho - mean) / kStep);
  return {static_cast<int>(steps.r), static_cast<int>(steps.g), static_cast<int>(steps.b)};
}

}  // namespace

void set_mean_reflectance(SceneInput& input) {
  if (input.face_rho.empty()) return;
  std::vector<AreaMean> means(input.materials.size());
  for (std::size_t k = 0; k < input.polygons.size(); ++k) {
    const InputPolygon& polygon = input.polygons[k];
    const std::size_t material = index(polygon.material);
    if (input.materials[material].textured) means[material].add(input.face_rho[k], area(polygon.corners));
  }
  for (std::size_t m = 0; m < means.size(); ++m)
    if (means[m].area > 0) input.materials[m].rho = means[m].mean();
}

void set_reflectance(MaterialId material, const Rgb& rho, SceneInput& input) {
  input.materials[index(material)].rho = rho;
  input.materials[index(material)].textured = false;
  for (std::size_t k = 0; k < input.face_rho.size(); ++k)
    if (input.polygons[k].material == material) input.face_rho[k] = rho;
}

std::vector<MaterialId> split_by_reflectance(const SceneInput& input, std::vector<Material>& materials,
                                             std::vector<std::string>& notes) {
  std::vector<MaterialId> of_polygons;
  double whole = 0;
  for (const InputPolygon& polygon : input.polygons) {
    of_polygons.push_back(polygon.material);
    whole += area(polygon.corners);
  }

  const std::size_t before = materials.size();
  std::vector<AreaMean> means(before);
  std::map<std::pair<MaterialId, std::array<int, kChannels>>, MaterialId> by_step;
  std::size_t moved = 0;
  for (std::size_t k = 0; k < input.face_rho.size(); ++k) {
    const MaterialId material = of_polygons[k];
    const double face_area = area(input.polygons[k].corners);
    const InputMaterial& whole_material = input.materials[index(material)];
    if (whole_material.textured && face_area > kLeastFaceShare * whole) {
      const auto step = step_of(input.face_rho[k], whole_material.rho);
      if (step != std::array<int, kChannels>{}) {
        const auto next = MaterialId{static_cast<std::uint32_t>(materials.size())};
        const auto [entry, added] = by_step.try_emplace({material, step}, next);
        if (added) {
          Material own = materials[index(material)];
          own.name += fmt::format(" (face {})", k + 1);
          materials.push_back(std::move(own));
          means.emplace_back();
        }
        of_polygons[k] = entry->second;
        ++moved;
      }
    }
    means[index(of_polygons[k])].add(input.face_rho[k], face_area);
  }
  for (std::size_t m = 0; m < means.size(); ++m) {
    const bool from_faces = m >= before || input.materials[m].textured;
    if (from_faces && means[m].area > 0) materials[m].rho = means[m].mean();
  }
  if (moved > 0)
    notes.push_back(
        fmt::format("textures: {} large {} by more than {} from the mean of their material, and "
                    "share {} {} of their own",
                    moved, moved == 1 ? "face differs" : "faces differ", kStep / 2, materials.size() - before,
                    materials.size() - before == 1 ? "material" : "materials"));
  return of_polygons;
}

}  // namespace fluxel

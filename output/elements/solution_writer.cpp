#include "output/elements/solution_writer.hpp"

#include <algorithm>

#include "core/input_error_at.hpp"
#include "output/elements/element_file.hpp"

namespace fluxel {

namespace {

constexpr const char* kRightSolution =
    "give the solution.ply of a run with the same geometry, camera and subdivision; lights, reflectances and "
    "solver may differ";

bool same_outline(const Outline<glm::dvec3>& a, const Outline<glm::dvec3>& b) {
  return a.corners == b.corners &&
         std::equal(a.corner.begin(), a.corner.begin() + a.corners, b.corner.begin());
}

std::vector<ElementLayer> layers_of(const SurfaceLight& light) {
  std::vector<ElementLayer> layers{{kRadiosity, light.B_front}};
  if (!light.B_back.empty()) layers.push_back({kRadiosityBack, light.B_back});
  return layers;
}

}  // namespace

void write_solution(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                    const SurfaceLight& light, std::span<const std::uint8_t> rgb,
                    const std::string& comment) {
  write_element_file(file, file_elements(scene, mesh), layers_of(light), rgb, comment);
}

void write_triangles(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                     const SurfaceLight& light, std::span<const std::uint8_t> rgb,
                     const std::string& comment) {
  const FileElements elements = file_elements(scene, mesh);
  FileElements triangles;
  SurfaceLight of_triangles;
  std::vector<std::uint8_t> colours;
  for (std::size_t i = 0; i < elements.outlines.size(); ++i) {
    const Outline<glm::dvec3>& outline = elements.outlines[i];
    for (std::size_t k = 2; k < outline.corners; ++k) {
      triangles.outlines.push_back({{outline.corner[0], outline.corner[k - 1], outline.corner[k]}, 3});
      triangles.patches.push_back(elements.patches[i]);
      of_triangles.B_front.push_back(light.B_front[i]);
      if (!light.B_back.empty()) of_triangles.B_back.push_back(light.B_back[i]);
      const auto colour = rgb.subspan(kChannels * i, kChannels);
      colours.insert(colours.end(), colour.begin(), colour.end());
    }
  }
  write_element_file(file, triangles, layers_of(of_triangles), colours, comment);
}

std::vector<Rgb> read_solution(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                               bool two_sided) {
  const ElementFile solution = read_element_file(file);
  const FileElements expected = file_elements(scene, mesh);
  const auto front = solution.layers.find(kRadiosity), back = solution.layers.find(kRadiosityBack);
  if (front == solution.layers.end()) throw input_error_at(file, 0, "holds no radiosity", kRightSolution);
  if ((back != solution.layers.end()) != two_sided || solution.elements.patches != expected.patches ||
      !std::ranges::equal(solution.elements.outlines, expected.outlines, same_outline))
    throw input_error_at(file, 0, "is a solution of other elements", kRightSolution);
  std::vector<Rgb> B = front->second;
  if (two_sided) B.insert(B.end(), back->second.begin(), back->second.end());
  return B;
}

}  // namespace fluxel

#include "bench/visibility/scenes.hpp"

#include <cmath>
#include <limits>

#include "app/command_line.hpp"
#include "core/options.hpp"
#include "subdivision/subdivide.hpp"

namespace fluxel::bench {

namespace {

void cut_into_triangles(SceneInput& input) {
  std::vector<InputPolygon> triangles;
  for (const InputPolygon& polygon : input.polygons)
    for (std::size_t c = 2; c < polygon.corners.size(); ++c) {
      InputPolygon& triangle = triangles.emplace_back(polygon);
      triangle.corners = {polygon.corners[0], polygon.corners[c - 1], polygon.corners[c]};
    }
  input.polygons = std::move(triangles);
}

ElementMesh subdivide(const Scene& scene, double max_edge) {
  SplitCriterion criterion;
  criterion.max_edge = max_edge;
  return subdivide_pieces(scene, 0, scene.pieces.size(), {}, criterion).mesh;
}

double distance(const ElementMesh& mesh, std::size_t wanted) {
  return std::abs(static_cast<double>(mesh.elements.size()) - static_cast<double>(wanted));
}

}  // namespace

std::vector<SceneSource> scene_sources(const std::filesystem::path& large_scenes) {
  const std::filesystem::path own(FLUXEL_BENCH_SCENES);
  return {
      {"room-of-12-boxes", own / "room-of-boxes/room-of-12-boxes.toml", {}},
      {"room-of-180-boxes", own / "room-of-boxes/room-of-180-boxes.toml", {}},
      {"cornell-box", own / "cornell-box/cornell-box.toml", {}},
      {"construction-in-wood", own / "construction-in-wood/construction-in-wood.toml", {}},
      {"office-2391", own / "office-2391/office-2391.toml", {}},
      {"room-12", large_scenes / "room-12.obj", {}},
      {"room-180", large_scenes / "room-180.obj", {}},
      {"modern-hall",
       large_scenes / "modern-hall.obj",
       {"--eye", "6.911821295180567,1.6516303433984643,2.5541356265944657", "--look-at",
        "6.011643710408107,1.6516302965772593,2.118612343670267", "--fov", "70"}},
      {"wooden-staircase",
       large_scenes / "wooden-staircase.obj",
       {"--eye", "0.032420927097472935,1.5267276149815672,4.881970480788412", "--look-at",
        "0.0247749097978693,1.5717826235996408,3.8830149873122095", "--fov", "58.54398"}},
  };
}

LoadedScene load_scene(const SceneSource& source, bool triangles) {
  // Elements are made here, so the edge length is of no matter; but the command line wants to know it.
  std::vector<std::string> arguments{"solve",   source.file.string(), "--sides", "one", "--subdivision",
                                     "uniform", "--max-edge",         "1"};
  arguments.insert(arguments.end(), source.options.begin(), source.options.end());
  SolveRequest request = std::get<SolveRequest>(read_command_line(arguments));
  if (triangles) cut_into_triangles(request.input);
  SceneSettings settings{request.options.sides, request.options.ke, request.options.cut, std::nullopt};
  if (request.options.camera) settings.camera_eye = request.options.camera->eye;
  settings.merge = request.options.merge && !triangles;
  return {build_scene(request.input, settings), request.options.camera};
}

ElementMesh subdivide_to_size(const Scene& scene, std::size_t wanted) {
  ElementMesh best = subdivide(scene, std::numeric_limits<double>::infinity());
  if (best.elements.size() >= wanted) return best;
  // No element is larger than the square of the edge, and only needles are much smaller.
  double longer = 4 * scene.extent;
  double shorter = 0.1 * std::sqrt(piece_area(scene) / static_cast<double>(wanted));
  constexpr int kSteps = 24;  // to a millionth of the edge
  for (int step = 0; step < kSteps && distance(best, wanted) > 0; ++step) {
    const double edge = std::sqrt(longer * shorter);
    ElementMesh mesh = subdivide(scene, edge);
    (mesh.elements.size() > wanted ? shorter : longer) = edge;
    if (distance(mesh, wanted) < distance(best, wanted)) best = std::move(mesh);
  }
  return best;
}

Scene scene_of_elements(const Scene& scene, const ElementMesh& mesh) {
  Scene result;
  result.name = scene.name;
  result.origin = scene.origin;
  result.extent = scene.extent;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    Patch patch = scene.patch(mesh.elements[i].patch);
    patch.outline.corners = mesh.outlines[i].corners;
    for (std::size_t c = 0; c < patch.outline.corners; ++c)
      patch.outline.corner[c] = glm::dvec3(mesh.outlines[i].corner[c]);
    patch.area = static_cast<double>(mesh.elements[i].area);
    result.patches.push_back(patch);
  }
  return result;
}

}  // namespace fluxel::bench

#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/command_line.hpp"
#include "core/options.hpp"
#include "scene/scene_input.hpp"

namespace fluxel::test {

/// `fluxel solve scenes/NAME/NAME.toml --method matrix ARGUMENTS...`, read by the rank itself.
inline SolveRequest scene_request(const std::string& name, const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"solve", FLUXEL_SOURCE_DIR "/scenes/" + name + "/" + name + ".toml",
                               "--method", "matrix"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return std::get<SolveRequest>(read_command_line(all));
}

/// Two facing squares of 1 m, 1 m apart, one of which is a light: fewer patches, elements and tiles than
/// ranks.
inline SolveRequest two_squares() {
  SolveRequest request;
  SceneInput& input = request.input;
  input.name = "two squares";
  input.materials = {{"white", Rgb(0.5), Rgb(0), std::nullopt, std::nullopt},
                     {"light", Rgb(0.2), Rgb(1, 2, 3), std::nullopt, std::nullopt}};
  input.groups = {"floor", "lamp"};
  input.polygons = {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, MaterialId{0}, GroupId{0}},
                    {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, MaterialId{1}, GroupId{1}}};
  request.options.sides = Sides::one;
  request.options.subdivision = Subdivision::none;
  return request;
}

inline Scene scene_of(const SolveRequest& request) {
  SceneSettings settings{request.options.sides, request.options.ke, request.options.cut, std::nullopt};
  if (request.options.camera) settings.camera_eye = request.options.camera->eye;
  settings.merge = request.options.merge;
  return build_scene(request.input, settings);
}

/// Scenes on which what is promised to be equal is checked, small and each of another kind.
struct NamedRequest {
  std::string name;
  SolveRequest request;
};
inline std::vector<NamedRequest> small_requests() {
  return {
      {"open, one-sided, cut", scene_request("cornell-box", {"--resolution", "24x24"})},
      {"two-sided",
       scene_request("construction-in-wood", {"--resolution", "16x16", "--sides", "two", "--max-edge", "1"})},
      {"without camera criterion",
       scene_request("emitting-wall", {"--subdivision", "uniform", "--max-edge", "0.26"})},
      {"supersampled", scene_request("three-rectangles", {"--resolution", "12x10", "--supersample", "2"})},
      {"fewer patches than ranks", two_squares()}};
}

}  // namespace fluxel::test

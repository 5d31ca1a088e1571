#include <CLI/CLI.hpp>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"
#include "output/output_table.hpp"
#include "scene/readers/geometry_formats.hpp"

namespace fluxel {

void declare_scene_file(CLI::App* command, std::string& scene, std::optional<double>& metres_per_unit) {
  command->add_option("scene", scene, "scene file (.toml) or geometry (" + geometry_extensions() + ")")
      ->required();
  add_parsed(
      command, "metres-per-unit",
      [&metres_per_unit](const std::string& t) { metres_per_unit = parse_above_zero(t); },
      "unit of geometry: 0.001 for millimetres (default 1; a scene file has its own)", "M")
      ->group("Scene");
}

void declare_scene(CLI::App* command, Options& options) {
  const char* group = "Scene";
  add_choice(command, "sides", options.sides, kSidesNames,
             "sides of a patch that send and receive (default two)")
      ->group(group);
  add_choice(command, "ke", options.ke, kKeNames,
             "what Ke of an MTL file means (default radiance, as exporters write it)")
      ->group(group);
  add_choice(
      command, "textures", options.textures, kTexturesNames,
      "reflectance of textures: the mean over all faces of a material (default mean), or of each large "
      "face that differs from it (face)")
      ->group(group);
  command
      ->add_flag("--thermal", options.thermal,
                 "heat between grey surfaces (temperatures, fluxes) in place of light")
      ->group(group);
  command
      ->add_flag_callback(
          "--no-cut", [&options] { options.cut = false; },
          "leave patches whole where others touch or cross them")
      ->group(group);
  command
      ->add_flag_callback(
          "--keep-polygons", [&options] { options.merge = false; },
          "do not merge coplanar polygons of one material and group into larger ones; so it is with --no-cut "
          "and --subdivision none")
      ->group(group);
}

void declare_live(CLI::App* command, Options& options) {
  command
      ->add_flag(
          "--live", options.live,
          "write the page of the run (.html) while it lasts, for a browser that reads it again by itself")
      ->group("Run");
}

void declare_specular(CLI::App* command, Specular& specular, const std::map<std::string, Specular>& names,
                      const std::string& otherwise) {
  add_choice(command, "specular", specular, names,
             "surfaces that do more than reflect evenly: " + otherwise +
                 " (default), or take them as black but for rho")
      ->group("Scene");
}

void declare_camera(CLI::App* command, Options& options, CameraParts& camera) {
  const char* group = "Camera and picture";
  add_parsed(
      command, "camera", [&camera](const std::string& t) { camera.name = t; },
      "camera of the scene (default: its first) or of a JSON file with keys eye, look_at, up, fov, "
      "resolution; the options below replace single values",
      "NAME|FILE.json")
      ->group(group);
  add_parsed(
      command, "eye", [&camera](const std::string& t) { camera.eye = parse_vector(t); }, "position [m]",
      "x,y,z")
      ->group(group);
  add_parsed(
      command, "look-at", [&camera](const std::string& t) { camera.look_at = parse_vector(t); },
      "point in the middle of the picture [m]", "x,y,z")
      ->group(group);
  add_parsed(
      command, "up", [&camera](const std::string& t) { camera.up = parse_vector(t); },
      "direction that is up (default 0,1,0)", "x,y,z")
      ->group(group);
  add_parsed(
      command, "fov", [&camera](const std::string& t) { camera.fov = parse_number(t); },
      "vertical angle of view (default 45)", "DEGREES")
      ->group(group);
  add_parsed(
      command, "resolution",
      [&camera](const std::string& t) {
        const auto [width, height] = parse_resolution(t);
        camera.resolution = glm::ivec2(width, height);
      },
      "pixels (default 256x256)", "WxH")
      ->group(group);
  add_parsed(
      command, "exposure", [&options](const std::string& t) { options.exposure = parse_number(t); },
      "of image.png (default: chosen)", "STOPS")
      ->group(group);
  add_choice(
      command, "tone", options.tone, kToneNames,
      "of image.png: luminance as it is, or by a curve that compresses what is bright (default reinhard)")
      ->group(group);
}

void declare_receivers(CLI::App* command, Options& options) {
  const char* group = "Receivers and tasks";
  add_parsed(
      command, "false-colour-max",
      [&options](const std::string& t) { options.false_colour.max = parse_above_zero(t); },
      "value of the last colour of false-colour pictures (default: of each picture its own)", "VALUE")
      ->group(group);
  add_parsed(
      command, "false-colour-decades",
      [&options](const std::string& t) { options.false_colour.decades = parse_above_zero(t); },
      "their scale is logarithmic, over so many powers of ten (default: linear, from 0)", "N")
      ->group(group);
  add_parsed(
      command, "maintenance-factor",
      [&options](const std::string& t) { options.maintenance_factor = parse_above_zero(t); },
      "of the illuminances that [[tasks]] are judged by: what is left of a new installation's (default 1)",
      "F")
      ->group(group);
}

void declare_meshes(CLI::App* command, Options& options) {
  const char* group = "Run";
  add_parsed(
      command, "write", [&options](const std::string& t) { options.write = parse_names(t, asked_names()); },
      "files beside solution.ply: vtu (for ParaView), glb (for Blender and browsers), glb-quantised (half as "
      "long), ply-triangles, lightmap (light in a texture over all surfaces), false-colour (of the picture)",
      "NAME,...")
      ->join(',')
      ->group(group);
  add_parsed(
      command, "mesh-max-edge",
      [&options](const std::string& t) { options.mesh_max_edge = parse_above_zero(t); },
      "longest edge of faces of solution.vtu and solution.glb, at which light is gathered as at pixels [m] "
      "(default: they are the elements)",
      "M")
      ->group(group);
  add_parsed(
      command, "lightmap-texel",
      [&options](const std::string& t) { options.lightmap_texel = parse_above_zero(t); },
      "size of the texels of the light map, at which light is gathered as at pixels [m] (default: what fits "
      "into 1024 x 1024 texels)",
      "M")
      ->group(group);
}

void declare_error_limits(CLI::App* command, ErrorLimits& limits, const std::string& group) {
  add_parsed(
      command, "target-error", [&limits](const std::string& t) { limits.target_error = parse_number(t); },
      "end when the standard errors' root mean square over the mean is below, of each kind of sensor "
      "(default "
      "0.01 where no other limit is given)",
      "E")
      ->group(group);
  add_parsed(
      command, "absolute-error",
      [&limits](const std::string& t) { limits.absolute_error = parse_above_zero(t); },
      "the same of the errors themselves, in the unit of what is measured", "X")
      ->group(group);
  add_parsed(
      command, "target-of", [&limits](const std::string& t) { limits.of = t; },
      "whose error that is (default: of each)", "elements|RECEIVER")
      ->group(group);
}

void declare_device(CLI::App* command, Options& options, const std::string& work, const std::string& parts) {
  const char* group = "Run";
  add_choice(
      command, "device", options.device, kDeviceNames,
      "what " + work +
          ": the processor (default cpu), a GPU in every rank (cuda), or in those that have one (auto)")
      ->group(group);
  add_parsed(
      command, "verify-device", [&options](const std::string& t) { options.verify_device = parse_number(t); },
      "share of a GPU's " + parts + " that the processor makes again, to compare (default 0.0001)",
      "FRACTION")
      ->group(group);
}

void declare_picture(CLI::App* command, Options& options) {
  const char* group = "Camera and picture";
  command
      ->add_option_function<int>(
          "--supersample",
          [&options](int rays) {
            options.supersample = rays;
            options.antialias = false;
          },
          "rays a pixel along each axis, averaged (default: one in the pixel's centre, and 16 where "
          "surfaces "
          "meet)")
      ->type_name("K")
      ->check(CLI::Range(1, 64))
      ->group(group);
  add_parsed(
      command, "filter", [&options](const std::string& t) { options.median_radius = parse_median_radius(t); },
      "on the finished picture: median of each channel within R pixels (default none)", "none|median:R")
      ->group(group);
}

}  // namespace fluxel

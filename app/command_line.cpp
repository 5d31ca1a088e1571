#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/option_checks.hpp"
#include "app/subcommands.hpp"
#include "app/version_text.hpp"
#include "core/error.hpp"

namespace fluxel {

namespace {

/// All options, each declared once; the scene file's go through the same declarations.
struct Parser {
  SolveArguments solve_arguments;
  ReferenceOptions reference_options;
  ViewFactorOptions view_factor_options;
  CompareOptions compare_options;
  CLI::App app{"Fluxel computes how light or heat spreads between diffuse surfaces.", "fluxel"};
  CLI::App* solve = add_command("solve", "radiosity of a scene: picture, solution and report");
  CLI::App* reference =
      add_command("reference", "the truth by paths of light, with its error, to judge solutions by");
  CLI::App* viewfactors =
      add_command("viewfactors", "view factors between the groups of a scene, as a table");
  CLI::App* compare = add_command("compare", "how far a solution or a picture is off a reference");

  Parser() {
    app.require_subcommand(1);
    app.set_version_flag("--version", version_text());
    declare_solve(solve, solve_arguments);
    declare_reference(reference, solve_arguments, reference_options);
    declare_viewfactors(viewfactors, view_factor_options);
    declare_compare(compare, compare_options);
  }

  CLI::App* add_command(const std::string& name, const std::string& text) {
    CLI::App* command = app.add_subcommand(name, text);
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    return command;
  }

  /// The sub-command that the arguments begin with, or null.
  [[nodiscard]] const CLI::App* command_of(const std::vector<std::string>& arguments) const {
    const auto found = app.get_subcommands([&](const CLI::App* command) {
      return !arguments.empty() && command->get_name() == arguments.front();
    });
    return found.empty() ? nullptr : found.front();
  }

  void parse(std::vector<std::string> arguments) {
    std::ranges::reverse(arguments);  // as CLI11 wants them
    app.parse(arguments);
  }
};

/// The camera of the scene file, below what the command line says of it.
CameraParts camera_of_scene(const InputCamera& camera) {
  CameraParts parts;
  if (camera.eye) parts.eye = camera.eye->value;
  if (camera.look_at) parts.look_at = camera.look_at->value;
  if (camera.up) parts.rest.up = camera.up->value;
  if (camera.fov) parts.rest.fov = camera.fov->value;
  if (camera.resolution) {
    parts.rest.width = camera.resolution->value.x;
    parts.rest.height = camera.resolution->value.y;
  }
  return parts;
}

/// Options that tell of a picture or of light, while there is none.
std::vector<std::string> warn_of_idle_options(const Parser& parser, const InputCamera& camera) {
  const Options& options = parser.solve_arguments.options;
  std::vector<std::string> warnings;
  if (options.thermal && parser.solve->count("--ke") > 0)
    warnings.emplace_back("with --thermal materials emit by their temperature: --ke has no effect");
  if (parser.solve->count("--checkpoint-every") > 0) {
    if (options.checkpoint.empty())
      warnings.emplace_back("without --checkpoint nothing is kept: --checkpoint-every has no effect");
    else if (options.method == Method::hierarchical)
      warnings.emplace_back(
          "--method hierarchical keeps every finished round: --checkpoint-every has no effect");
  }
  if (options.camera) return warnings;
  std::string names;
  for (const std::string name : {"up", "fov", "resolution", "supersample", "filter", "exposure"})
    if (parser.solve->count("--" + name) > 0 || camera.line_of(name))
      names += (names.empty() ? "--" : ", --") + name;
  if (!names.empty())
    warnings.push_back(
        fmt::format("without --eye and --look-at there is no picture: {} has no effect", names));
  return warnings;
}

/// Heat needs no picture: a thermal run without a camera takes what it can.
void choose_thermal_subdivision(Options& options) {
  if (!options.thermal || options.camera) return;
  options.subdivision = options.max_edge ? Subdivision::uniform : Subdivision::none;
}

/// An error that is asked for asks for the method that knows its own; that one makes its own elements.
void choose_method(Parser& parser) {
  Options& options = parser.solve_arguments.options;
  if ((options.target_error || options.block_error) && parser.solve->count("--method") == 0)
    options.method = Method::hierarchical;
  if (options.method == Method::hierarchical && parser.solve->count("--subdivision") == 0)
    options.subdivision = Subdivision::transport;
}

/// Patches that are elements stay as fine as their file has them; and uncut they stay whole where others
/// touch them, so that larger ones would be worse.
void choose_merging(Options& options) {
  if (options.subdivision == Subdivision::none || !options.cut) options.merge = false;
}

/// Flags take true and false as others take their values.
std::string as_argument(const InputOption& option) { return "--" + option.name + "=" + option.value; }

/// Options of a scene file as arguments, each tried alone first so that its own line can be named.
std::vector<std::string> scene_arguments(const SceneInput& input, const std::string& scene) {
  std::vector<std::string> arguments;
  for (const InputOption& option : input.options) {
    try {
      Parser().parse({"solve", scene, as_argument(option)});
    } catch (const CLI::ParseError& error) {
      throw input_error_at(input.file, option.line, fmt::format("option '{}': {}", option.name, error.what()),
                           "options are those of 'fluxel solve --help', without dashes");
    }
    arguments.push_back(as_argument(option));
  }
  return arguments;
}

/// The options of the scene file below those of the command line.
SolveRequest read_solve(const std::string& scene, const std::vector<std::string>& arguments) {
  SolveRequest request;
  request.input = read_scene_input(scene);
  std::vector<std::string> merged = scene_arguments(request.input, scene);
  merged.insert(merged.begin(), "solve");
  merged.insert(merged.end(), arguments.begin() + 1, arguments.end());
  Parser parser;
  parser.solve_arguments.camera = camera_of_scene(request.input.camera);
  parser.parse(merged);
  Options& options = parser.solve_arguments.options;
  options.camera = finished_camera(parser.solve_arguments.camera);
  if (parser.solve->count("--subdivision") == 0) choose_thermal_subdivision(options);
  choose_method(parser);
  choose_merging(options);
  check_options(options);
  request.options = options;
  request.warnings = warn_of_idle_options(parser, request.input.camera);
  return request;
}

/// Of a scene file's options those of the scene and the camera count; the others are a solve's.
ReferenceRequest read_reference(const std::string& scene, const std::vector<std::string>& arguments) {
  ReferenceRequest request;
  request.input = read_scene_input(scene);
  std::vector<std::string> of_scene = scene_arguments(request.input, scene);
  of_scene.insert(of_scene.begin(), {"solve", scene});
  Parser parser;
  parser.solve_arguments.camera = camera_of_scene(request.input.camera);
  parser.parse(of_scene);
  parser.solve_arguments.options.out = "reference";  // not where a solve writes
  parser.parse(arguments);
  request.options = parser.reference_options;
  Options& run = request.options.run;
  run = parser.solve_arguments.options;
  run.camera = finished_camera(parser.solve_arguments.camera);
  // Whose patches a solve of the scene file would have.
  if (run.subdivision == Subdivision::camera) choose_thermal_subdivision(run);
  choose_merging(run);
  check_reference_options(request.options);
  if (!request.options.measures_elements() && !request.options.measures_picture() &&
      (request.input.receivers.empty() || !request.options.measures(Measured::receivers)))
    throw InputError(
        "there is nothing to measure: give a camera (--eye and --look-at), the elements of a solution "
        "(--elements out/solution.ply), or [[receivers]] in the scene file");
  return request;
}

}  // namespace

Request read_command_line(const std::vector<std::string>& arguments) {
  Parser parser;
  const CLI::App* command = parser.command_of(arguments);
  try {
    parser.parse(arguments);
    if (parser.solve->parsed()) return read_solve(parser.solve_arguments.options.scene, arguments);
    if (parser.compare->parsed()) return CompareRequest{parser.compare_options};
    if (parser.reference->parsed()) return read_reference(parser.solve_arguments.options.scene, arguments);
    const ViewFactorOptions& view_factors = parser.view_factor_options;
    if (!(view_factors.tolerance > 0)) throw InputError("--tolerance must be above 0");
    return ViewFactorRequest{view_factors, read_scene_input(view_factors.scene)};
  } catch (const CLI::CallForHelp&) {
    return TextRequest{(command != nullptr ? *command : parser.app).help()};
  } catch (const CLI::CallForVersion&) {
    return TextRequest{version_text() + "\n"};
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("{} (see 'fluxel {} --help')", error.what(),
                                 command != nullptr ? command->get_name() : "solve"));
  }
}

}  // namespace fluxel

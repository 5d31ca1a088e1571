#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/choose_camera.hpp"
#include "app/help_text.hpp"
#include "app/idle_options.hpp"
#include "app/option_checks.hpp"
#include "app/subcommands.hpp"
#include "app/usage_errors.hpp"
#include "core/input_error_at.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"
#include "formfactor/surface_exchange.hpp"
#include "method/bake.hpp"
#include "method/methods.hpp"
#include "output/version_text.hpp"
#include "scene/readers/doubtful_unit.hpp"

namespace fluxel {

namespace {

/// All options, each declared once; the scene file's go through the same declarations.
struct Parser {
  SolveArguments solve_arguments;
  ReferenceOptions reference_options;
  PhotonOptions photon_options;
  ViewFactorOptions view_factor_options;
  CompareOptions compare_options;
  CLI::App app{"Fluxel computes how light or heat spreads between diffuse surfaces.", "fluxel"};
  CLI::App* solve = add_command("solve", "radiosity of a scene: picture, solution and report");
  CLI::App* reference =
      add_command("reference", "the truth by paths of light, with its error, to judge solutions by");
  CLI::App* photons = add_command("photons", "light followed from what emits it, by mirrors and glass too");
  CLI::App* view = add_command("view", "the light of a finished solve, seen from elsewhere");
  CLI::App* viewfactors =
      add_command("viewfactors", "view factors between the groups of a scene, as a table");
  CLI::App* info =
      add_command("info", "what a scene holds, what is suspicious of it, and what a solve would take");
  CLI::App* compare = add_command("compare", "how far a solution or a picture is off a reference");

  Parser() {
    app.require_subcommand(1);
    app.set_version_flag("--version", version_text());
    app.set_help_flag("-h,--help", "show this, or the help of a command, and end");
    declare_solve(solve, solve_arguments);
    declare_reference(reference, solve_arguments, reference_options);
    declare_photons(photons, solve_arguments, photon_options);
    declare_view(view, solve_arguments);
    declare_viewfactors(viewfactors, view_factor_options);
    declare_info(info, solve_arguments);
    declare_compare(compare, compare_options);
  }

  CLI::App* add_command(const std::string& name, const std::string& text) {
    CLI::App* command = app.add_subcommand(name, text);
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->set_help_flag("-h,--help", "show what is needed first, and end");
    command->set_help_all_flag("--help-all", "show all options, and end");
    return command;
  }

  /// The sub-command that the arguments begin with, or null.
  [[nodiscard]] CLI::App* command_of(const std::vector<std::string>& arguments) {
    const auto found = app.get_subcommands(
        [&](CLI::App* command) { return !arguments.empty() && command->get_name() == arguments.front(); });
    return found.empty() ? nullptr : found.front();
  }

  void parse(std::vector<std::string> arguments) {
    std::ranges::reverse(arguments);  // as CLI11 wants them
    app.parse(arguments);
  }
};

/// Heat needs no picture: a thermal run without a camera takes what it can.
void choose_thermal_subdivision(Options& options) {
  if (!options.thermal || options.camera) return;
  options.subdivision = options.max_edge ? Subdivision::uniform : Subdivision::none;
}

/// The options that were given, without dashes.
std::vector<std::string> given_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 && !option->get_lnames().empty()) names.push_back(option->get_lnames().front());
  return names;
}

/// The command line decides before the scene file, and an error that is asked for asks for the method that
/// knows its own.
Method choose_method(const CLI::App& given, Method of_both) {
  if (given.count("--method") > 0) return of_both;
  for (const std::string error : {"target-error", "block-error"})
    if (given.count("--" + error) > 0) return method_knowing(error);
  return of_both;
}

/// Where none is asked for: the method's own.
void choose_subdivision(Options& options) {
  options.subdivision = row_of(options.method).subdivision;
  if (options.subdivision == Subdivision::camera) choose_thermal_subdivision(options);
}

/// Whether an option of the scene file was meant for another method than the one that was chosen.
bool is_for_another(const InputOption& option, const MethodRow& method, const Options& merged) {
  if (is_own_option(option.name) && !method.knows(option.name)) return true;
  if (method.refuses(option.name, option.value)) return true;
  return option.name == "max-edge" && merged.subdivision == Subdivision::transport &&
         !method.refuses("subdivision", "transport");
}

/// Whether the command line gives another option in place of one of the scene file.
bool is_replaced(const InputOption& option, const CLI::App& given, const Options& merged) {
  if (option.name == "target-error") return given.count("--block-error") > 0;
  if (option.name == "block-error") return given.count("--target-error") > 0;
  return option.name == "max-edge" && given.count("--subdivision") > 0 &&
         merged.subdivision == Subdivision::none;
}

/// Takes out the scene file's options that were meant for another method; a sentence that says so, or none.
std::string drop_unknown(const MethodRow& method, const Options& merged, std::vector<InputOption>& options) {
  std::string names;
  std::erase_if(options, [&](const InputOption& option) {
    if (!is_for_another(option, method, merged)) return false;
    names += (names.empty() ? "" : ", ") + option.name;
    return true;
  });
  if (names.empty()) return {};
  return fmt::format(
      "the scene file's options {} are of another method than {}: they have no part in this run", names,
      method.name);
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
  const auto refuse = [&](const InputOption& option, const std::string& why) {
    throw input_error_at(input.file, option.line, fmt::format("option '{}': {}", option.name, why),
                         "options are those of 'fluxel solve --help-all', without dashes");
  };
  for (const InputOption& option : input.options) {
    if (option.name == "metres-per-unit")
      refuse(option, "is of geometry files alone: it is metres_per_unit of [[geometry]] here");
    Parser alone;
    try {
      alone.parse({"solve", scene, as_argument(option)});
      check_numbers(alone.solve_arguments.options);
    } catch (const CLI::CallForHelp&) {
      refuse(option, "is none of a run");
    } catch (const CLI::CallForAllHelp&) {
      refuse(option, "is none of a run");
    } catch (const CLI::ParseError& error) {
      refuse(option, usage_sentence(error, *alone.solve));
    } catch (const InputError& error) {
      refuse(option, error.what());
    }
    arguments.push_back(as_argument(option));
  }
  return arguments;
}

/// The options of the scene file below those of the command line.
void parse_merged(const SceneInput& input, const std::string& scene,
                  const std::vector<std::string>& arguments, Parser& parser) {
  std::vector<std::string> merged = scene_arguments(input, scene);
  merged.insert(merged.begin(), "solve");
  merged.insert(merged.end(), arguments.begin() + 1, arguments.end());
  parser.parse(merged);
}

/// What makes the scene's unit doubtful is the first of the warnings.
void doubt_unit(const SceneInput& input, std::vector<std::string>& warnings) {
  if (std::optional<std::string> doubt = doubt_of_unit(input))
    warnings.insert(warnings.begin(), std::move(*doubt));
}

/// `given`: the command line alone.
SolveRequest read_solve(const Parser& given, const std::vector<std::string>& arguments) {
  const std::string& scene = given.solve_arguments.options.scene;
  SolveRequest request;
  request.input = read_scene_input(scene, given.solve_arguments.options.metres_per_unit);
  Parser both;
  parse_merged(request.input, scene, arguments, both);
  const Method method = choose_method(*given.solve, both.solve_arguments.options.method);
  check_known(given_options(*given.solve), method);
  std::erase_if(request.input.options, [&](const InputOption& option) {
    return is_replaced(option, *given.solve, both.solve_arguments.options);
  });
  const std::string dropped =
      drop_unknown(row_of(method), both.solve_arguments.options, request.input.options);

  Parser parser;
  parse_merged(request.input, scene, arguments, parser);
  Options& options = parser.solve_arguments.options;
  options.method = method;
  options.camera = choose_camera(parser.solve_arguments.camera, request.input, *given.solve);
  if (parser.solve->count("--subdivision") == 0) choose_subdivision(options);
  choose_merging(options);
  check_options(options);
  request.options = options;
  request.warnings = warn_of_idle_options(
      *parser.solve, options, camera_of_file(request.input, parser.solve_arguments.camera.name).camera);
  doubt_unit(request.input, request.warnings);
  if (!dropped.empty()) request.warnings.push_back(dropped);
  if (const Method of_scene = both.solve_arguments.options.method; method != of_scene)
    request.warnings.push_back(
        fmt::format("the command line asks for an error: --method {} takes the place of the scene file's {}",
                    row_of(method).name, row_of(of_scene).name));
  return request;
}

/// The scene file's options alone.
void parse_scene_options(const SceneInput& input, const std::string& scene, Parser& parser) {
  std::vector<std::string> of_scene = scene_arguments(input, scene);
  of_scene.insert(of_scene.begin(), {"solve", scene});
  parser.parse(of_scene);
}

/// Of a scene file's options those of the scene, the camera, the picture and the launch count; the others are
/// a solve's.
ReferenceRequest read_reference(const Options& given, const std::vector<std::string>& arguments) {
  ReferenceRequest request;
  request.input = read_scene_input(given.scene, given.metres_per_unit);
  Parser parser;
  parse_scene_options(request.input, given.scene, parser);
  const bool has_subdivision = parser.solve->count("--subdivision") > 0;
  parser.solve_arguments.options.out = "reference";  // not where a solve writes
  parser.parse(arguments);
  request.options = parser.reference_options;
  Options& run = request.options.run;
  run = parser.solve_arguments.options;
  if (run.specular == Specular::refuse) run.specular = Specular::follow;
  run.camera = choose_camera(parser.solve_arguments.camera, request.input, *parser.reference);
  // Whose patches a solve of the scene file would have.
  if (!has_subdivision) choose_subdivision(run);
  choose_merging(run);
  check_reference_options(request.options);
  if (!request.options.measures_elements() && !request.options.measures_picture() &&
      ((request.input.receivers.empty() && request.input.observers.empty()) ||
       !request.options.measures(Measured::receivers)))
    throw InputError(
        "there is nothing to measure: give a camera (--eye and --look-at), the elements of a solution "
        "(--elements out/solution.ply), or [[receivers]] in the scene file");
  request.warnings = warn_of_idle_options(*parser.reference, request.options);
  doubt_unit(request.input, request.warnings);
  return request;
}

/// Of a scene file's options those of the scene; the camera decides which sides are sealed, as for a solve.
PhotonsRequest read_photons(const Options& given, const std::vector<std::string>& arguments) {
  PhotonsRequest request;
  request.input = read_scene_input(given.scene, given.metres_per_unit);
  Parser parser;
  parse_scene_options(request.input, given.scene, parser);
  const bool has_subdivision = parser.solve->count("--subdivision") > 0;
  Options& of_scene = parser.solve_arguments.options;
  of_scene.out = "photons";
  of_scene.resume = false;
  of_scene.checkpoint.clear();
  of_scene.max_edge.reset();
  parser.parse(arguments);
  request.options = parser.photon_options;
  Options& run = request.options.run;
  run = parser.solve_arguments.options;
  run.camera = choose_camera({}, request.input, *parser.photons);
  if (run.specular == Specular::refuse) run.specular = Specular::follow;
  if (!request.options.elements.empty()) {
    // Whose patches a solve of the scene file would have.
    if (!has_subdivision) choose_subdivision(run);
  } else {
    run.subdivision = run.max_edge ? Subdivision::uniform : Subdivision::none;
  }
  choose_merging(run);
  run.method = Method::photons;
  check_photon_options(request.options);
  if (!request.options.changed_from.empty())
    request.before = read_scene_input(request.options.changed_from, given.metres_per_unit);
  request.warnings = warn_of_idle_options(*parser.photons, request.options);
  doubt_unit(request.input, request.warnings);
  return request;
}

/// What a view has of a solve's options.
Options options_of_view(const Options& of) {
  Options view;
  view.scene = of.scene;
  view.metres_per_unit = of.metres_per_unit;
  view.out = of.out;
  view.write = of.write;
  view.mesh_max_edge = of.mesh_max_edge;
  view.lightmap_texel = of.lightmap_texel;
  view.method = Method::view;
  view.solution = of.solution;
  view.supersample = of.supersample;
  view.antialias = of.antialias;
  view.median_radius = of.median_radius;
  view.exposure = of.exposure;
  view.tone = of.tone;
  view.false_colour = of.false_colour;
  view.maintenance_factor = of.maintenance_factor;
  view.sides = of.sides;
  view.specular = of.specular;
  view.ke = of.ke;
  view.textures = of.textures;
  view.thermal = of.thermal;
  view.cut = of.cut;
  view.merge = of.merge;
  view.target_error = of.target_error;
  view.picture = of.picture;
  view.audit = of.audit;
  view.threads = of.threads;
  view.isa = of.isa;
  view.device = of.device;
  view.verify_device = of.verify_device;
  view.quiet = of.quiet;
  view.live = of.live;
  return view;
}

SolveRequest read_view(const Options& given, const std::vector<std::string>& arguments) {
  SolveRequest request;
  request.input = read_scene_input(given.scene, given.metres_per_unit);
  Parser parser;
  parse_scene_options(request.input, given.scene, parser);
  Options& options = parser.solve_arguments.options;
  const bool has_subdivision = parser.solve->count("--subdivision") > 0;
  options.out = "view";
  parser.parse(arguments);
  if (!has_subdivision) choose_subdivision(options);
  choose_merging(options);
  request.options = options_of_view(options);
  request.options.camera = choose_camera(parser.solve_arguments.camera, request.input, *parser.view);
  check_options(request.options);
  if (request.options.thermal)
    throw InputError(
        "fluxel view shows light: a thermal scene's temperatures stand in the solve's thermal.csv");
  if (!request.options.camera && request.input.receivers.empty() && request.input.observers.empty() &&
      !bakes(request.options))
    throw InputError(
        "there is nothing to look at: give a camera (--eye and --look-at), [[receivers]] in the scene file, "
        "or "
        "--write lightmap, or vtu or glb with --mesh-max-edge");
  request.warnings =
      warn_of_idle_options(*parser.view, request.options,
                           camera_of_file(request.input, parser.solve_arguments.camera.name).camera);
  doubt_unit(request.input, request.warnings);
  // It is not to be written over.
  request.input.files.emplace_back(request.options.solution);
  return request;
}

/// What a forecast by the hierarchical method has of a solve's options.
Options options_of_forecast(const Options& of) {
  Options forecast;
  forecast.scene = of.scene;
  forecast.metres_per_unit = of.metres_per_unit;
  forecast.supersample = of.supersample;
  forecast.antialias = of.antialias;
  forecast.sides = of.sides;
  forecast.specular = Specular::absorb;
  forecast.ke = of.ke;
  forecast.thermal = of.thermal;
  forecast.cut = of.cut;
  forecast.merge = of.merge;
  forecast.target_error = of.target_error;
  forecast.error_of = of.error_of;
  forecast.oracle = of.oracle;
  forecast.exchange = of.exchange;
  forecast.picture = of.picture;
  forecast.memory = of.memory;
  forecast.audit = of.audit;
  forecast.threads = of.threads;
  forecast.isa = of.isa;
  forecast.dry_run = true;
  return forecast;
}

InfoRequest read_info(const Options& given, const std::vector<std::string>& arguments) {
  InfoRequest request;
  request.input = read_scene_input(given.scene, given.metres_per_unit);
  Parser parser;
  parse_scene_options(request.input, given.scene, parser);
  parser.parse(arguments);
  request.options = options_of_forecast(parser.solve_arguments.options);
  choose_merging(request.options);
  request.options.camera = choose_camera(parser.solve_arguments.camera, request.input, *parser.solve);
  check_options(request.options);
  return request;
}

}  // namespace

std::optional<std::string> text_asked_for(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = arguments;
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
    if (words.size() > 1 && Parser().command_of(words) == nullptr) return std::nullopt;
  }
  Parser parser;
  CLI::App* command = parser.command_of(words);
  CLI::App& of = command != nullptr ? *command : parser.app;
  try {
    parser.parse(words);
  } catch (const CLI::CallForHelp&) {
    return help_text(of, false);
  } catch (const CLI::CallForAllHelp&) {
    return help_text(of, true);
  } catch (const CLI::CallForVersion&) {
    return version_text() + "\n";
  } catch (const CLI::ParseError&) {  // read_command_line says what is wrong
  }
  return std::nullopt;
}

namespace {

Request read_request(const std::vector<std::string>& arguments) {
  Parser parser;
  const CLI::App* command = parser.command_of(arguments);
  if (command == nullptr && !arguments.empty() && !arguments.front().starts_with('-')) {
    const std::string& word = arguments.front() == "help" ? arguments.back() : arguments.front();
    throw InputError(unknown_command(parser.app, word) + " (see 'fluxel --help')");
  }
  try {
    parser.parse(arguments);
    if (parser.solve->parsed()) return read_solve(parser, arguments);
    if (parser.compare->parsed()) return CompareRequest{parser.compare_options};
    const Options& given = parser.solve_arguments.options;
    if (parser.reference->parsed()) return read_reference(given, arguments);
    if (parser.photons->parsed()) return read_photons(given, arguments);
    if (parser.view->parsed()) return read_view(given, arguments);
    if (parser.info->parsed()) return read_info(given, arguments);
    const ViewFactorOptions& view_factors = parser.view_factor_options;
    if (!(view_factors.tolerance >= kMinViewFactorTolerance))
      throw InputError(fmt::format(
          "--tolerance must be {:g} or more: contour integrals and rays know view factors no better",
          kMinViewFactorTolerance));
    ViewFactorRequest request{view_factors,
                              read_scene_input(view_factors.scene, view_factors.metres_per_unit)};
    static_cast<void>(scene_arguments(request.input, view_factors.scene));  // a solve's, and right or wrong
    return request;
  } catch (const CLI::ParseError& error) {
    const CLI::App& of = command != nullptr ? *command : parser.app;
    throw InputError(fmt::format("{} (see 'fluxel {}--help')", usage_sentence(error, of),
                                 command != nullptr ? command->get_name() + " " : ""));
  }
}

/// As a shell takes it.
std::string quoted(const std::string& word) {
  static constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char letter : word) letter == '\'' ? text += "'\\''" : text += letter;
  return text + "'";
}

std::string& command_in(SolveRequest& request) { return request.options.command; }
std::string& command_in(ReferenceRequest& request) { return request.options.run.command; }
std::string& command_in(PhotonsRequest& request) { return request.options.run.command; }
std::string& command_in(ViewFactorRequest& request) { return request.options.command; }
std::string& command_in(InfoRequest& request) { return request.options.command; }
std::string& command_in(CompareRequest& request) { return request.options.command; }

}  // namespace

Request read_command_line(const std::vector<std::string>& arguments) {
  Request request = read_request(arguments);
  std::string command = "fluxel";
  for (const std::string& word : arguments) command += " " + quoted(word);
  std::visit([&](auto& of) { command_in(of) = command; }, request);
  return request;
}

}  // namespace fluxel

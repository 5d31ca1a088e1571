#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "app/option_checks.hpp"
#include "app/option_names.hpp"
#include "app/option_values.hpp"
#include "app/version_text.hpp"
#include "core/error.hpp"

namespace fluxel {

namespace {

/// All options, each declared once; the scene file's go through the same declarations.
struct Parser {
  Options options;
  CameraParts camera;
  CLI::App app{"Fluxel computes how light or heat spreads between diffuse surfaces.", "fluxel"};
  ViewFactorOptions view_factor_options;
  CLI::App* solve = nullptr;
  CLI::App* viewfactors = nullptr;

  Parser() {
    app.require_subcommand(1);
    app.set_version_flag("--version", version_text());
    solve = app.add_subcommand("solve", "radiosity of a scene: picture, solution and report");
    solve->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    solve->add_option("scene", options.scene, "scene file (.toml) or geometry (.obj)")->required();
    add_run_options();
    add_checkpoint_options();
    add_scene_options();
    add_camera_options();
    add_method_options();
    add_viewfactors();
  }

  template <class Parse>
  CLI::Option* add_parsed(const std::string& name, Parse parse, const std::string& text,
                          const std::string& type) {
    return add_parsed_to(solve, name, parse, text, type);
  }

  template <class Parse>
  static CLI::Option* add_parsed_to(CLI::App* command, const std::string& name, Parse parse,
                                    const std::string& text, const std::string& type) {
    const auto read = [name, parse](const std::string& value) {
      try {
        parse(value);
      } catch (const CLI::ValidationError& error) {
        throw CLI::ValidationError("--" + name, error.what());
      }
    };
    return command->add_option_function<std::string>("--" + name, read, text)->type_name(type);
  }

  template <class Value>
  CLI::Option* add_choice(const std::string& name, Value& value, const std::map<std::string, Value>& names,
                          const std::string& text) {
    return add_choice_to(solve, name, value, names, text);
  }

  template <class Value>
  static CLI::Option* add_choice_to(CLI::App* command, const std::string& name, Value& value,
                                    const std::map<std::string, Value>& names, const std::string& text) {
    std::string choices;
    for (const auto& entry : names) choices += (choices.empty() ? "" : "|") + entry.first;
    return add_parsed_to(
        command, name,
        [&value, &names, choices](const std::string& word) {
          const auto found = names.find(word);
          if (found == names.end())
            throw CLI::ValidationError(fmt::format("'{}' is none of {}", word, choices));
          value = found->second;
        },
        text, choices);
  }

  void add_run_options() {
    const char* group = "Run";
    solve->add_option("--out", options.out, "folder for all output")->capture_default_str()->group(group);
    solve->add_option("--threads", options.threads, "threads in a rank (default: its CPU set)")
        ->check(CLI::Range(1, 4096))
        ->group(group);
    add_choice("isa", options.isa, kIsaNames,
               "instruction set of all vector code (default auto: the best there is)")
        ->group(group);
    solve->add_flag("--quiet", options.quiet, "print warnings and errors only")->group(group);
    solve
        ->add_flag("--trace-every-pair", options.trace_every_pair,
                   "settle no pair without its own ray: slow, the same bits, to check the shortcuts")
        ->group(group);
    solve
        ->add_flag("--timeline", options.timeline,
                   "write timeline.csv: what each rank did when (scripts/chart-timeline)")
        ->group(group);
    solve->add_flag("--dry-run", options.dry_run, "predict elements, pairs, memory and time, then stop")
        ->group(group);
  }

  void add_checkpoint_options() {
    const char* group = "Checkpoint";
    solve
        ->add_option(
            "--checkpoint", options.checkpoint,
            "keep finished strips of visibility there: now and then, on SIGUSR1, on SIGUSR2 (which then ends "
            "the run with 75), and at the end of the phase")
        ->type_name("DIR")
        ->group(group);
    add_parsed(
        "checkpoint-every", [this](const std::string& t) { options.checkpoint_every = parse_number(t); },
        "between two writes of a rank (default 300)", "SECONDS")
        ->group(group);
    solve
        ->add_flag("--resume", options.resume,
                   "go on with the strips that --checkpoint holds, of whatever number of ranks; without any: "
                   "from the "
                   "start")
        ->group(group);
    solve
        ->add_flag("--visibility-only", options.visibility_only,
                   "end when the visibility is complete and kept")
        ->group(group);
    solve
        ->add_option(
            "--reuse-visibility", options.reuse_visibility,
            "take strips from there, and leave them as they are: lights, reflectances, solver may differ")
        ->type_name("DIR")
        ->group(group);
  }

  void add_scene_options() {
    const char* group = "Scene";
    add_choice("sides", options.sides, kSidesNames, "sides of a patch that send and receive (default two)")
        ->group(group);
    add_choice("ke", options.ke, kKeNames, "what Ke of an MTL file means (default exitance)")->group(group);
    solve
        ->add_flag("--thermal", options.thermal,
                   "heat between grey surfaces: emissivity and temperature [K] or heat_flux [W/m2] of the "
                   "materials in place of light; without a camera elements are uniform with --max-edge, else "
                   "whole patches")
        ->group(group);
    solve
        ->add_flag_callback(
            "--no-cut", [this] { options.cut = false; },
            "leave patches whole where others touch or cross them")
        ->group(group);
  }

  void add_camera_options() {
    const char* group = "Camera and picture";
    add_parsed(
        "eye", [this](const std::string& t) { camera.eye = parse_vector(t); }, "position [m]", "x,y,z")
        ->group(group);
    add_parsed(
        "look-at", [this](const std::string& t) { camera.look_at = parse_vector(t); },
        "point in the middle of the picture [m]", "x,y,z")
        ->group(group);
    add_parsed(
        "up", [this](const std::string& t) { camera.rest.up = parse_vector(t); },
        "direction that is up (default 0,1,0)", "x,y,z")
        ->group(group);
    add_parsed(
        "fov", [this](const std::string& t) { camera.rest.fov = parse_number(t); },
        "vertical angle of view (default 45)", "DEGREES")
        ->group(group);
    add_parsed(
        "resolution",
        [this](const std::string& t) {
          std::tie(camera.rest.width, camera.rest.height) = parse_resolution(t);
        },
        "pixels (default 256x256)", "WxH")
        ->group(group);
    solve->add_option("--supersample", options.supersample, "rays a pixel along each axis, averaged")
        ->check(CLI::Range(1, 64))
        ->capture_default_str()
        ->group(group);
    add_parsed(
        "filter", [this](const std::string& t) { options.filter = parse_filter(t); },
        "on the finished picture", "gaussian:SIGMA|median:R")
        ->group(group);
    add_parsed(
        "exposure", [this](const std::string& t) { options.exposure = parse_number(t); },
        "of image.png (default: chosen)", "STOPS")
        ->group(group);
  }

  void add_method_options() {
    const char* group = "Method";
    add_choice("subdivision", options.subdivision, kSubdivisionNames,
               "how elements are made (default camera)")
        ->group(group);
    add_parsed(
        "max-edge", [this](const std::string& t) { options.max_edge = parse_number(t); },
        "longest edge of an element [m]; with camera it bounds what is not seen (default: an eighth to a "
        "third as many elements as pixels)",
        "M")
        ->group(group);
    add_choice("subscenes", options.subscenes, kSubscenesNames,
               "rasters of the ranks' sub-scenes (default merged)")
        ->group(group);
    add_form_factor_options();
    add_solver_options();
  }

  void add_solver_options() {
    const char* group = "Solver";
    add_choice("solver", options.solver, kSolverNames, "linear solver (default auto: cg where it is safe)")
        ->group(group);
    add_parsed(
        "tolerance", [this](const std::string& t) { parse_tolerance(t, options); },
        "largest error of B over its area-mean, for each colour; auto: root mean square error at most SHARE "
        "of "
        "the estimated discretisation error (default auto:0.1)",
        "T|auto|auto:SHARE")
        ->group(group);
    solve->add_option("--max-iterations", options.max_iterations, "of the solver")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str()
        ->group(group);
    solve
        ->add_option(
            "--warm-start", options.warm_start,
            "start from the solution.ply of a run with the same elements (other lights, reflectances)")
        ->type_name("FILE")
        ->group(group);
    solve
        ->add_flag("--preview", options.preview,
                   "first shoot the brightest light for up to 8 s and write pictures after 1, 2, 4 and 8 s")
        ->group(group);
    solve
        ->add_flag_callback(
            "--no-error-estimate", [this] { options.error_estimate = false; },
            "leave out the estimate of the solution's error, which solves two coarser meshes")
        ->group(group);
  }

  void add_viewfactors() {
    ViewFactorOptions& of = view_factor_options;
    viewfactors = app.add_subcommand("viewfactors", "view factors between the groups of a scene, as a table");
    viewfactors->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    viewfactors->add_option("scene", of.scene, "scene file (.toml) or geometry (.obj)")->required();
    viewfactors->add_option("--out", of.out, "CSV file to write")->required();
    add_parsed_to(
        viewfactors, "tolerance", [&of](const std::string& t) { of.tolerance = parse_number(t); },
        "relative error of a factor (default 1e-3); where something stands between, sqrt(1e-3 T)", "T");
    add_choice_to(viewfactors, "sides", of.sides, kSidesNames,
                  "sides of a patch that see (default one, the front)");
    viewfactors->add_flag_callback(
        "--no-cut", [&of] { of.cut = false; }, "leave patches whole where others touch or cross them");
    viewfactors->add_option("--threads", of.threads, "threads in a rank (default: its CPU set)")
        ->check(CLI::Range(1, 4096));
    viewfactors->add_flag("--quiet", of.quiet, "print warnings and errors only");
  }

  void add_form_factor_options() {
    const char* group = "Form factors";
    FormFactorOptions& form_factor = options.form_factor;
    add_parsed(
        "form-factor", [&form_factor](const std::string& t) { parse_form_factor(t, form_factor); },
        "rule for a pair (default adaptive)", "adaptive|disc|point|points:MxN")
        ->group(group);
    add_parsed(
        "form-factor-tolerance",
        [&form_factor](const std::string& t) { form_factor.tolerance = parse_number(t); },
        "of adaptive: about the largest error of a row's sum (default 1e-3)", "T")
        ->group(group);
    solve
        ->add_flag_callback(
            "--no-partial-visibility", [&form_factor] { form_factor.partial_visibility = false; },
            "of adaptive: a pair is visible or not, by one ray")
        ->group(group);
    solve
        ->add_flag(
            "--closure", form_factor.closure,
            "scale the form factors, symmetrically, until the row sums are 1 less what leaves the scene")
        ->group(group);
  }

  void parse(std::vector<std::string> arguments) {
    std::ranges::reverse(arguments);  // as CLI11 wants them
    app.parse(arguments);
  }
};

/// Options that tell of a picture or of light, while there is none.
std::vector<std::string> warn_of_idle_options(const Parser& parser) {
  std::vector<std::string> warnings;
  if (parser.options.thermal && parser.solve->count("--ke") > 0)
    warnings.emplace_back("with --thermal materials emit by their temperature: --ke has no effect");
  if (parser.options.checkpoint.empty() && parser.solve->count("--checkpoint-every") > 0)
    warnings.emplace_back("without --checkpoint nothing is kept: --checkpoint-every has no effect");
  if (parser.options.camera) return warnings;
  std::string names;
  for (const char* name : {"--up", "--fov", "--resolution", "--supersample", "--filter", "--exposure"})
    if (parser.solve->count(name) > 0) names += (names.empty() ? "" : ", ") + std::string(name);
  if (!names.empty())
    warnings.push_back(
        fmt::format("without --eye and --look-at there is no picture: {} has no effect", names));
  return warnings;
}

/// Heat needs no picture: a thermal run without a camera takes what it can.
void choose_thermal_subdivision(Parser& parser) {
  Options& options = parser.options;
  if (!options.thermal || options.camera || parser.solve->count("--subdivision") > 0) return;
  options.subdivision = options.max_edge ? Subdivision::uniform : Subdivision::none;
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

}  // namespace

Request read_command_line(const std::vector<std::string>& arguments) {
  try {
    Parser first;
    first.parse(arguments);
    if (first.viewfactors->parsed()) {
      if (!(first.view_factor_options.tolerance > 0)) throw InputError("--tolerance must be above 0");
      return ViewFactorRequest{first.view_factor_options, read_scene_input(first.view_factor_options.scene)};
    }
    SolveRequest request;
    request.input = read_scene_input(first.options.scene);

    std::vector<std::string> merged = scene_arguments(request.input, first.options.scene);
    merged.insert(merged.begin(), "solve");
    merged.insert(merged.end(), arguments.begin() + 1, arguments.end());
    Parser second;
    second.parse(merged);
    second.options.camera = finished_camera(second.camera);
    choose_thermal_subdivision(second);
    check_options(second.options);
    request.options = second.options;
    request.warnings = warn_of_idle_options(second);
    return request;
  } catch (const CLI::CallForHelp&) {
    Parser parser;
    const std::string command = arguments.empty() ? "" : arguments.front();
    if (command == "solve") return TextRequest{parser.solve->help()};
    return TextRequest{command == "viewfactors" ? parser.viewfactors->help() : parser.app.help()};
  } catch (const CLI::CallForVersion&) {
    return TextRequest{version_text() + "\n"};
  } catch (const CLI::ParseError& error) {
    const bool of_viewfactors = !arguments.empty() && arguments.front() == "viewfactors";
    throw InputError(
        fmt::format("{} (see 'fluxel {} --help')", error.what(), of_viewfactors ? "viewfactors" : "solve"));
  }
}

}  // namespace fluxel

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <tuple>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"
#include "method/methods.hpp"

namespace fluxel {

namespace {

void add_run_options(CLI::App* solve, Options& options) {
  const char* group = "Run";
  solve->add_option("--out", options.out, "folder for all that is written")
      ->capture_default_str()
      ->check(refuse_empty)
      ->group(group);
  declare_meshes(solve, options);
  solve->add_option("--threads", options.threads, "threads in a rank (default: its CPU set)")
      ->check(CLI::Range(1, 4096))
      ->group(group);
  add_choice(solve, "isa", options.isa, kIsaNames,
             "instruction set of all vector code (default auto: the best there is)")
      ->group(group);
  declare_device(solve, options, "makes visibility and, where it fits, the solve's products", "tiles");
  solve->add_flag("--quiet", options.quiet, "print warnings and errors only")->group(group);
  declare_live(solve, options);
  solve
      ->add_flag("--trace-every-pair", options.trace_every_pair,
                 "settle no pair without its own ray: slow, the same bits, to check the shortcuts")
      ->group(group);
  solve
      ->add_flag("--timeline", options.timeline,
                 "write timeline.csv: what each rank did when (scripts/chart-timeline)")
      ->group(group);
  solve
      ->add_flag("--dry-run", options.dry_run,
                 "predict memory and time, then stop: by the first two rounds (hierarchical), by samples of "
                 "all pairs (matrix)")
      ->group(group);
}

void add_checkpoint_options(CLI::App* solve, Options& options) {
  const char* group = "Checkpoint";
  solve
      ->add_flag(
          "--keep-links", options.keep_links,
          "keep what nodes exchange light by, in the folder links beside solution.ply: fluxel view then "
          "needs no rays for pictures from elsewhere")
      ->group(group);
  solve
      ->add_option("--checkpoint", options.checkpoint,
                   "keep finished work there, to go on with by --resume (see docs/checkpoint.md)")
      ->check(refuse_empty)
      ->type_name("DIR")
      ->group(group);
  add_parsed(
      solve, "checkpoint-every",
      [&options](const std::string& t) { options.checkpoint_every = parse_number(t); },
      "between two writes of a rank's strips (default 300)", "SECONDS")
      ->group(group);
  solve
      ->add_flag("--resume", options.resume,
                 "go on with the strips or the round that --checkpoint holds, of whatever number of ranks; "
                 "without any: from the start")
      ->group(group);
  solve
      ->add_flag("--visibility-only", options.visibility_only, "end when the visibility is complete and kept")
      ->group(group);
  solve
      ->add_option(
          "--reuse-visibility", options.reuse_visibility,
          "take strips from there, and leave them as they are: lights, reflectances, solver may differ")
      ->check(refuse_empty)
      ->type_name("DIR")
      ->group(group);
}

void add_form_factor_options(CLI::App* solve, Options& options) {
  const char* group = "Form factors";
  FormFactorOptions& form_factor = options.form_factor;
  add_parsed(
      solve, "form-factor", [&form_factor](const std::string& t) { parse_form_factor(t, form_factor); },
      "rule for a pair (default adaptive)", "adaptive|disc|point|points:MxN")
      ->group(group);
  add_parsed(
      solve, "form-factor-tolerance",
      [&form_factor](const std::string& t) { form_factor.tolerance = parse_number(t); },
      "of adaptive: about the largest error of a row's sum (default 1e-3)", "T")
      ->group(group);
  solve
      ->add_flag_callback(
          "--no-partial-visibility", [&form_factor] { form_factor.partial_visibility = false; },
          "of adaptive: a pair is visible or not, by one ray")
      ->group(group);
  solve
      ->add_flag("--closure", form_factor.closure,
                 "scale the form factors, symmetrically, until the row sums are 1 less what leaves the scene")
      ->group(group);
}

void add_solver_options(CLI::App* solve, Options& options) {
  const char* group = "Solver";
  add_choice(solve, "solver", options.solver, kSolverNames,
             "linear solver (default auto: cg where it is safe)")
      ->group(group);
  add_parsed(
      solve, "tolerance", [&options](const std::string& t) { parse_tolerance(t, options); },
      "largest error of B over its area-mean, for each colour; auto: root mean square error at most SHARE "
      "of the estimated discretisation error (default auto:0.1)",
      "T|auto|auto:SHARE")
      ->group(group);
  solve->add_option("--max-iterations", options.max_iterations, "of the solver")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->group(group);
  solve
      ->add_option("--warm-start", options.warm_start,
                   "start from the solution.ply of a run with the same elements (other lights, reflectances)")
      ->check(refuse_empty)
      ->type_name("FILE")
      ->group(group);
  solve
      ->add_flag(
          "--preview", options.preview,
          "early pictures: of each round at a quarter of the resolution (hierarchical), of the brightest "
          "light shot for 1, 2, 4 and 8 s (matrix)")
      ->group(group);
  solve
      ->add_flag_callback(
          "--no-error-estimate", [&options] { options.error_estimate = false; },
          "leave out the two coarser meshes, which tell the error and start the iteration")
      ->group(group);
}

void add_method_options(CLI::App* solve, Options& options) {
  const char* group = "Method";
  static const std::map<std::string, Method> methods = methods_of("solve");  // outlives the command
  add_choice(solve, "method", options.method, methods, "how light is computed (default hierarchical)")
      ->group(group);
  add_parsed(
      solve, "target-error", [&options](const std::string& t) { options.target_error = parse_number(t); },
      "relative error (rms) that the picture, or without a camera the surfaces, may have (default 0.01)", "E")
      ->group(group);
  add_choice(
      solve, "error-of", options.error_of, kErrorOfNames,
      "what --target-error is of: the picture or the surfaces, over the mean of all; regions: also the "
      "mean of each, over its own (default picture, without a camera surfaces)")
      ->group(group);
  add_parsed(
      solve, "block-error", [&options](const std::string& t) { options.block_error = parse_number(t); },
      "of hierarchical, in place of --target-error: what a link may leave, root mean square over all "
      "surfaces, over the mean",
      "E")
      ->group(group);
  add_choice(
      solve, "oracle", options.oracle, kOracleNames,
      "of hierarchical: what refines a link beside its geometry, the power that is sent and what the camera "
      "sees of it (default all)")
      ->group(group);
  add_choice(solve, "exchange", options.exchange, kExchangeNames,
             "of hierarchical: light goes by links between nodes or by rays from each of them (default auto: "
             "rays for pictures of more than 600 faces, with --keep-links of more than 20,000)")
      ->group(group);
  add_choice(
      solve, "picture", options.picture, kPictureNames,
      "where pixels have their light from, the elements, a gather at each, or that of emitters at each and "
      "reflected light at few, interpolated (default cached)")
      ->group(group);
  add_parsed(
      solve, "memory", [&options](const std::string& t) { options.memory = parse_bytes(t); },
      "of a rank: coarser where it would take more (default: what there is)", "BYTES[K|M|G]")
      ->group(group);
  add_time(solve, options.seconds,
           "of the whole run, from its start: end with the best picture that there is then, however far off "
           "(default: no limit)")
      ->group(group);
  add_parsed(
      solve, "audit", [&options](const std::string& t) { options.audit = parse_number(t); },
      "share of the work that goes into measuring the error by paths of light, more where that decides "
      "whether the target is reached; 0: none (default 0.1)",
      "SHARE")
      ->group(group);
  add_choice(solve, "subdivision", options.subdivision, kSubdivisionNames,
             "how elements are made (default: the leaves of hierarchical; of matrix by the camera)")
      ->group(group);
  add_parsed(
      solve, "max-edge", [&options](const std::string& t) { options.max_edge = parse_number(t); },
      "longest edge of an element [m]; with camera it bounds what is not seen (default: an eighth to a "
      "third as many elements as pixels)",
      "M")
      ->group(group);
  add_choice(solve, "subscenes", options.subscenes, kSubscenesNames,
             "rasters of the ranks' sub-scenes (default merged)")
      ->group(group);
}

}  // namespace

void declare_solve(CLI::App* solve, SolveArguments& arguments) {
  Options& options = arguments.options;
  declare_scene_file(solve, options.scene, options.metres_per_unit);
  // In the order of the help: what is asked for, how, of what, and then the run.
  declare_camera(solve, options, arguments.camera);
  declare_picture(solve, options);
  declare_receivers(solve, options);
  add_method_options(solve, options);
  add_form_factor_options(solve, options);
  add_solver_options(solve, options);
  declare_scene(solve, options);
  declare_specular(solve, options.specular, kSpecularNames, "refuse them");
  add_run_options(solve, options);
  add_checkpoint_options(solve, options);
}

}  // namespace fluxel

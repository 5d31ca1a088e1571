#include <CLI/CLI.hpp>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"

namespace fluxel {

void declare_view(CLI::App* view, SolveArguments& of) {
  const char* group = "View";
  Options& options = of.options;
  declare_scene_file(view, options.scene, options.metres_per_unit);
  view->add_option("--solution", options.solution,
                   "solution.ply of a solve of this scene, with the same --sides and --no-cut")
      ->required()
      ->check(refuse_empty)
      ->type_name("FILE")
      ->group(group);
  add_parsed(
      view, "target-error", [&options](const std::string& t) { options.target_error = parse_number(t); },
      "relative error (rms) that the picture may have, of which gathering it takes 0.7 (default 0.01)", "E")
      ->group(group);
  add_choice(
      view, "picture", options.picture, kPictureNames,
      "where pixels have their light from, the elements, a gather at each, or that of emitters at each "
      "and reflected light at few, interpolated (default cached)")
      ->group(group);
  add_parsed(
      view, "audit", [&options](const std::string& t) { options.audit = parse_number(t); },
      "share of the work that goes into measuring the error by paths of light, more where that decides "
      "whether the target is reached; 0: none (default 0.1)",
      "SHARE")
      ->group(group);
  view->add_option("--out", options.out, "folder for all output (default view)")
      ->check(refuse_empty)
      ->group("Run");
  view->add_option("--threads", options.threads, "threads in a rank (default: its CPU set)")
      ->check(CLI::Range(1, 4096))
      ->group("Run");
  declare_meshes(view, options);
  declare_device(view, options, "finds what rays of a picture meet first", "rays");
  view->add_flag("--quiet", options.quiet, "print warnings and errors only")->group("Run");
  declare_live(view, options);
  declare_scene(view, options);
  declare_specular(view, options.specular, kSpecularNames, "refuse them");
  declare_camera(view, options, of.camera);
  declare_picture(view, options);
  declare_receivers(view, options);
}

}  // namespace fluxel

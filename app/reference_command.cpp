#include <CLI/CLI.hpp>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"

namespace fluxel {

void declare_reference(CLI::App* reference, SolveArguments& run, ReferenceOptions& of) {
  const char* group = "Reference";
  Options& options = run.options;
  declare_scene_file(reference, options.scene, options.metres_per_unit);
  reference
      ->add_option("--elements", of.elements,
                   "measure the mean radiosity of the elements of this solution.ply (or reference.ply)")
      ->check(refuse_empty)
      ->type_name("FILE")
      ->group(group);
  add_choice(reference, "only", of.only, kMeasuredNames,
             "measure these alone (default: elements where they are given, the picture where there is a "
             "camera, and the scene's receivers)")
      ->group(group);
  declare_error_limits(reference, of.limits.error, group);
  add_time(reference, of.limits.seconds, "end each of them then")->group(group);
  add_parsed(
      reference, "rays", [&of](const std::string& t) { of.limits.rays = parse_count(t); },
      "end each of them after about so many", "N")
      ->group(group);
  add_choice(reference, "sampling", of.sampling, kSamplingNames,
             "deal samples to blocks of 64 sensors by how much they vary, or as many to every sensor")
      ->capture_default_str()
      ->group(group);
  reference->add_option("--seed", of.seed, "of all random numbers")->capture_default_str()->group(group);
  reference
      ->add_option("--supersample", of.supersample,
                   "measure pixels by the K x K points that a solve's picture is made of (default: over the "
                   "whole of their area)")
      ->type_name("K")
      ->check(CLI::Range(1, 64))
      ->group(group);
  reference->add_option("--out", options.out, "folder for all output (default reference)")
      ->check(refuse_empty)
      ->group("Run");
  reference->add_option("--threads", options.threads, "threads in a rank (default: its CPU set)")
      ->check(CLI::Range(1, 4096))
      ->group("Run");
  declare_device(reference, options, "follows paths of light", "paths");
  reference->add_flag("--quiet", options.quiet, "print warnings and errors only")->group("Run");
  declare_live(reference, options);
  declare_scene(reference, options);
  declare_specular(reference, options.specular, kFollowNames, "follow light by them");
  declare_camera(reference, options, run.camera);
  declare_receivers(reference, options);
}

}  // namespace fluxel

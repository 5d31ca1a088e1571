#include <CLI/CLI.hpp>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"

namespace fluxel {

void declare_photons(CLI::App* photons, SolveArguments& run, PhotonOptions& of) {
  const char* group = "Photons";
  Options& options = run.options;
  declare_scene_file(photons, options.scene, options.metres_per_unit);
  photons
      ->add_option("--elements", of.elements, "count on the elements of this solution.ply (or reference.ply)")
      ->check(refuse_empty)
      ->type_name("FILE")
      ->group(group);
  add_parsed(
      photons, "max-edge", [&options](const std::string& t) { options.max_edge = parse_above_zero(t); },
      "count on elements of this size [m] (default: on whole polygons)", "M")
      ->group(group);
  add_choice(photons, "only", of.only, kCountedNames,
             "count on these alone (default: on elements and the scene's receivers)")
      ->group(group);
  add_choice(photons, "sequence", of.sequence, kSequenceNames,
             "points that photons go by: Sobol's or Halton's, Sobol's with scrambled digits, or numbers that "
             "look random")
      ->capture_default_str()
      ->group(group);
  photons->add_option("--seed", of.seed, "of scrambled and random points")
      ->capture_default_str()
      ->group(group);
  declare_error_limits(photons, of.limits.error, group);
  add_time(photons, of.limits.seconds, "end then")->group(group);
  add_parsed(
      photons, "photons", [&of](const std::string& t) { of.limits.photons = parse_count(t); },
      "end after so many, those of earlier runs included", "N")
      ->group(group);
  add_parsed(
      photons, "received", [&of](const std::string& t) { of.limits.received = parse_count(t); },
      "end when so many have come to what --target-of names", "N")
      ->group(group);
  photons->add_option("--checkpoint", options.checkpoint, "folder of photons.tally (default: that of --out)")
      ->check(refuse_empty)
      ->type_name("DIR")
      ->group(group);
  add_parsed(
      photons, "checkpoint-every",
      [&options](const std::string& t) { options.checkpoint_every = parse_number(t); },
      "write photons.tally that often while photons are sent (default 300)", "S")
      ->group(group);
  photons->add_flag("--resume", options.resume, "go on with the photons of photons.tally")->group(group);
  photons
      ->add_option("--changed-from", of.changed_from,
                   "with --resume: photons.tally is of this scene file; photons that the change concerns go "
                   "again, those that it most concerns first (--sequence halton)")
      ->check(refuse_empty)
      ->type_name("SCENE")
      ->group(group);
  add_parsed(
      photons, "groups", [&of](const std::string& t) { of.groups = parse_count(t); },
      "into how many groups these are parted at most (default: a 128th of the photons)", "N")
      ->group(group);
  photons->add_option("--out", options.out, "folder for all output (default photons)")
      ->check(refuse_empty)
      ->group("Run");
  photons->add_option("--threads", options.threads, "threads in a rank (default: its CPU set)")
      ->check(CLI::Range(1, 4096))
      ->group("Run");
  photons->add_flag("--quiet", options.quiet, "print warnings and errors only")->group("Run");
  declare_live(photons, options);
  declare_scene(photons, options);
  declare_specular(photons, options.specular, kFollowNames, "follow light by them");
  declare_receivers(photons, options);
}

}  // namespace fluxel

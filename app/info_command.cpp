#include <CLI/CLI.hpp>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"
#include "core/options.hpp"

namespace fluxel {

void declare_info(CLI::App* info, SolveArguments& run) {
  Options& options = run.options;
  declare_scene_file(info, options.scene, options.metres_per_unit);
  add_parsed(
      info, "target-error", [&options](const std::string& t) { options.target_error = parse_number(t); },
      "the relative error of a solve whose links, memory and time are forecast (default 0.01)", "E");
  info->add_option("--threads", options.threads, "threads (default: the CPU set)")
      ->check(CLI::Range(1, 4096));
  declare_scene(info, options);
}

}  // namespace fluxel

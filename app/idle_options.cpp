#include "app/idle_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "method/idle_options.hpp"

namespace fluxel {

std::vector<std::string> warn_of_idle_options(const CLI::App& solve, const Options& options,
                                              const InputCamera& camera) {
  std::vector<std::string> warnings;
  for (const CLI::Option* option : solve.get_options()) {
    if (option->count() == 0) continue;
    const std::string_view why = idle_reason(option->get_single_name(), options);
    if (!why.empty()) warnings.push_back(fmt::format("{}: {} has no effect", why, option->get_name()));
  }
  if (options.camera) return warnings;
  std::string names;
  for (const std::string name : {"up", "fov", "resolution", "supersample", "filter", "exposure"})
    if (solve.count("--" + name) > 0 || camera.line_of(name)) names += (names.empty() ? "--" : ", --") + name;
  if (!names.empty())
    warnings.push_back(
        fmt::format("without --eye and --look-at there is no picture: {} has no effect", names));
  return warnings;
}

}  // namespace fluxel

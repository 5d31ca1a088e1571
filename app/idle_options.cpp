#include "app/idle_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>

namespace fluxel {

namespace {

/// When an option has no effect, and why.
struct IdleOption {
  const char* option;
  bool (*idle)(const Options&);
  const char* why;
};

bool is_not_adaptive(const Options& options) { return options.form_factor.rule != FormFactor::adaptive; }
bool is_dry(const Options& options) { return options.dry_run; }
bool ends_with_visibility(const Options& options) { return options.visibility_only; }

constexpr const char* kDry = "with --dry-run nothing is computed";
constexpr const char* kVisibility = "with --visibility-only nothing is solved";

constexpr std::array kIdleOptions{
    IdleOption{"ke", [](const Options& options) { return options.thermal; },
               "with --thermal materials emit by their temperature"},
    IdleOption{"checkpoint-every", [](const Options& options) { return options.checkpoint.empty(); },
               "without --checkpoint nothing is kept"},
    IdleOption{"subscenes", [](const Options& options) { return !options.camera; },
               "without a camera there are no rasters"},
    IdleOption{
        "subscenes",
        [](const Options& options) { return options.camera && options.subdivision != Subdivision::camera; },
        "elements of another --subdivision than camera do not depend on rasters"},
    IdleOption{"form-factor-tolerance", is_not_adaptive, "only --form-factor adaptive has a tolerance"},
    IdleOption{"no-partial-visibility", is_not_adaptive,
               "only --form-factor adaptive examines partly visible pairs"},
    IdleOption{"verify-device", [](const Options& options) { return options.device == Device::cpu; },
               "without --device cuda or auto there is nothing to verify"},
    IdleOption{"warm-start", is_dry, kDry},
    IdleOption{"preview", is_dry, kDry},
    IdleOption{"timeline", is_dry, kDry},
    IdleOption{"checkpoint", is_dry, kDry},
    IdleOption{"warm-start", ends_with_visibility, kVisibility},
    IdleOption{"preview", ends_with_visibility, kVisibility},
    IdleOption{"solver", ends_with_visibility, kVisibility},
    IdleOption{"tolerance", ends_with_visibility, kVisibility},
    IdleOption{"max-iterations", ends_with_visibility, kVisibility},
    IdleOption{"closure", ends_with_visibility, kVisibility}};

}  // namespace

std::vector<std::string> warn_of_idle_options(const CLI::App& solve, const Options& options,
                                              const InputCamera& camera) {
  std::vector<std::string> warnings;
  for (const IdleOption& row : kIdleOptions)
    if (solve.count(fmt::format("--{}", row.option)) > 0 && row.idle(options))
      warnings.push_back(fmt::format("{}: --{} has no effect", row.why, row.option));
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

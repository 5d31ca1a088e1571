#include "app/idle_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <vector>

#include "core/options.hpp"
#include "method/idle_options.hpp"

namespace fluxel {

namespace {

std::string sentence(std::string_view why, std::string_view options) {
  return fmt::format("{}: {} has no effect", why, options);
}

/// Those of the options that are given, as a list.
std::string given_of(const std::vector<const char*>& names,
                     const std::function<bool(const std::string&)>& given) {
  std::string list;
  for (const std::string name : names)
    if (given(name)) list += (list.empty() ? "--" : ", --") + name;
  return list;
}

/// Of those of the names that the command line gives.
void warn_of(const CLI::App& command, std::string_view why, const std::vector<const char*>& names,
             std::vector<std::string>& warnings) {
  const std::string list =
      given_of(names, [&](const std::string& name) { return command.count("--" + name) > 0; });
  if (!list.empty()) warnings.push_back(sentence(why, list));
}

/// `is_asked`: of something without a limit of errors.
void warn_of_target(const CLI::App& command, const ErrorLimits& limits, bool is_asked,
                    std::vector<std::string>& warnings) {
  if (!limits.are_set() && !is_asked)
    warn_of(command, "no error and no number of photons is asked of it", {"target-of"}, warnings);
}

}  // namespace

std::vector<std::string> warn_of_idle_options(const CLI::App& solve, const Options& options,
                                              const InputCamera& camera) {
  std::vector<std::string> warnings;
  for (const CLI::Option* option : solve.get_options()) {
    if (option->count() == 0) continue;
    const std::string_view why = idle_reason(option->get_single_name(), options);
    if (!why.empty()) warnings.push_back(sentence(why, option->get_name()));
  }
  if (options.camera) return warnings;
  std::vector<const char*> names{"camera", "up", "fov", "resolution", "supersample", "filter"};
  // Elements of a solve have colours, whether or not there is a picture.
  if (options.method == Method::view) names.insert(names.end(), {"exposure", "tone"});
  const std::string list = given_of(
      names, [&](const std::string& name) { return solve.count("--" + name) > 0 || camera.line_of(name); });
  if (!list.empty()) warnings.push_back(sentence("without --eye and --look-at there is no picture", list));
  return warnings;
}

std::vector<std::string> warn_of_idle_options(const CLI::App& reference, const ReferenceOptions& options) {
  std::vector<std::string> warnings;
  const auto warn = [&](bool idle, std::string_view why, const std::vector<const char*>& names) {
    if (idle) warn_of(reference, why, names, warnings);
  };
  warn(!options.measures(Measured::elements), "elements are not what --only asks for", {"elements"});
  warn(!options.measures_picture(), "no picture is measured",
       {"camera", "eye", "look-at", "up", "fov", "resolution", "supersample", "exposure", "tone"});
  warn_of_target(reference, options.limits.error, !(options.limits.seconds || options.limits.rays), warnings);
  warn(options.run.device == Device::cpu, idle_reason("verify-device", options.run), {"verify-device"});
  warn(options.run.thermal, idle_reason("ke", options.run), {"ke"});
  warn(options.run.thermal, idle_reason("textures", options.run), {"textures"});
  if (options.measures_picture() && options.supersample == 0 && options.run.supersample > 1)
    warnings.push_back(
        fmt::format("the scene file's supersample is a solve's: this reference measures pixels over their "
                    "whole area; give --supersample {} for the points of a solve's picture",
                    options.run.supersample));
  return warnings;
}

std::vector<std::string> warn_of_idle_options(const CLI::App& photons, const PhotonOptions& options) {
  std::vector<std::string> warnings;
  if (!options.measures(Measured::elements))
    warn_of(photons, "elements are not what --only asks for", {"elements", "max-edge"}, warnings);
  else if (!options.elements.empty())
    warn_of(photons, "the elements of a file stay as they are", {"max-edge"}, warnings);
  if (options.sequence == Sequence::sobol || options.sequence == Sequence::halton)
    warn_of(photons, "these points are always the same", {"seed"}, warnings);
  warn_of_target(photons, options.limits.error,
                 options.changed_from.empty() &&
                     (options.limits.received || !(options.limits.seconds || options.limits.photons)),
                 warnings);
  if (!options.changed_from.empty())
    warn_of(photons, "a renewal keeps the tally at its end", {"checkpoint-every"}, warnings);
  if (options.run.thermal) warn_of(photons, idle_reason("ke", options.run), {"ke", "textures"}, warnings);
  return warnings;
}

}  // namespace fluxel

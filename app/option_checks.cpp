#include "app/option_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/options.hpp"
#include "method/methods.hpp"
#include "output/option_json.hpp"

namespace fluxel {

namespace {

/// Values that the method refuses of options that it knows.
void check_values(const Options& options) {
  const MethodRow& method = row_of(options.method);
  const Json values = options_json(options);
  for (const RefusedValue& refused : method.refused)
    if (const auto value = values.find(refused.option); value != values.end() && *value == refused.value)
      throw InputError(std::string(refused.sentence));
  if (!method.has_tolerance_of_share && options.discretisation_share != Options{}.discretisation_share)
    throw InputError(fmt::format("--method {} knows no --tolerance auto:SHARE: give a number, or auto alone",
                                 method.name));
}

void check_time(const std::optional<double>& seconds) {
  if (seconds && !(*seconds > 0)) throw InputError("--time must be above 0 seconds");
}

void check_target_error(const std::optional<double>& error, double largest) {
  if (error && !(*error >= kLeastTargetError && *error <= largest))
    throw InputError(fmt::format(
        "--target-error must be {:g} or more{}, as 0.01 for one percent: single precision tells no less",
        kLeastTargetError, std::isfinite(largest) ? fmt::format(" and at most {:g}", largest) : ""));
}

void check_error_limits(const ErrorLimits& limits) {
  check_target_error(limits.target_error, std::numeric_limits<double>::infinity());
}

void check_receivers(const Options& options) {
  constexpr double kMostDecades = 12;
  if (options.thermal && options.false_colour.decades)
    throw InputError("--false-colour-decades has no meaning for temperatures: leave it out with --thermal");
  if (options.maintenance_factor > 1) throw InputError("--maintenance-factor must be 1 at most");
  if (options.false_colour.decades > kMostDecades)
    throw InputError(fmt::format("--false-colour-decades must be {:g} at most", kMostDecades));
}

void check_device(const Options& options) {
  if (!(options.verify_device >= 0 && options.verify_device <= 1))
    throw InputError("--verify-device must be from 0 to 1");
}

/// What makes the elements, and how large they are.
void check_subdivision(const Options& options) {
  if (options.subdivision == Subdivision::transport && options.max_edge)
    throw InputError(
        "--max-edge has no meaning for the elements that --method hierarchical makes by itself: leave it "
        "out, or ask for elements of that size by --subdivision uniform");
  if (options.subdivision == Subdivision::camera && !options.camera)
    throw InputError(
        "--subdivision camera needs a camera: give --eye and --look-at, or use --subdivision uniform "
        "or none");
  if (options.subdivision == Subdivision::uniform && !options.max_edge)
    throw InputError("--subdivision uniform needs --max-edge");
  if (options.subdivision == Subdivision::none && options.max_edge)
    throw InputError("--max-edge has no meaning with --subdivision none, which leaves patches whole");
}

}  // namespace

void check_numbers(const Options& options) {
  check_target_error(options.target_error, 1);
  check_time(options.seconds);
  check_device(options);
  check_receivers(options);
  if (options.block_error && !(*options.block_error > 0)) throw InputError("--block-error must be above 0");
  if (!(options.audit >= 0 && options.audit < 1))
    throw InputError("--audit must be at least 0 and below 1, as 0.1 for a tenth of the run's work");
  if (options.max_edge && !(*options.max_edge > 0)) throw InputError("--max-edge must be above 0");
  if (!(options.checkpoint_every > 0)) throw InputError("--checkpoint-every must be above 0 seconds");
  if (!(options.form_factor.tolerance > 0)) throw InputError("--form-factor-tolerance must be above 0");
}

void check_options(const Options& options) {
  check_values(options);
  check_numbers(options);
  check_subdivision(options);
  if (options.target_error && options.block_error)
    throw InputError("--block-error takes the place of --target-error: give one of them");
  if (options.trace_every_pair && options.device != Device::cpu)
    throw InputError("--trace-every-pair is of processors alone: leave out --device");
  if (options.oracle == Oracle::importance && !error_is_of_picture(options))
    throw InputError(
        "--oracle importance needs a picture that it can refine: give a camera, or leave it out");
  if (options.error_of == ErrorOf::picture && !error_is_of_picture(options))
    throw InputError(
        "--error-of picture needs a picture: give a camera, or --error-of surfaces (a thermal run has none)");
  if (options.resume && options.checkpoint.empty())
    throw InputError("--resume needs --checkpoint DIR, the folder that holds what to go on with");
  if (options.visibility_only && options.checkpoint.empty())
    throw InputError("--visibility-only needs --checkpoint DIR, the folder that keeps the visibility");
  if (options.preview && !options.camera)
    throw InputError("--preview makes pictures and needs a camera: give --eye and --look-at");
  if (options.camera &&
      static_cast<double>(options.supersample) * std::max(options.camera->width, options.camera->height) >
          65536)
    throw InputError("--resolution times --supersample is more than 65536 rays a side");
}

void check_known(const std::vector<std::string>& given, Method method) {
  const MethodRow& row = row_of(method);
  std::vector<std::string> unknown;
  std::ranges::copy_if(given, std::back_inserter(unknown), [&](const std::string& option) {
    return is_own_option(option) && !row.knows(option);
  });
  if (unknown.empty()) return;
  std::vector<std::string> others;
  for (const MethodRow& other : kMethods)
    if (other.command == row.command &&
        std::ranges::any_of(unknown, [&](const std::string& option) { return other.knows(option); }))
      others.push_back(fmt::format("--method {}", other.name));
  throw InputError(fmt::format("--method {} knows no --{}: leave {} out, or use {}", row.name,
                               fmt::join(unknown, " and no --"), unknown.size() > 1 ? "them" : "it",
                               fmt::join(others, " or ")));
}

void check_reference_options(const ReferenceOptions& options) {
  const ReferenceLimits& limits = options.limits;
  check_error_limits(limits.error);
  check_time(limits.seconds);
  check_device(options.run);
  check_receivers(options.run);
}

void require_measured(const ErrorLimits& limits, const std::vector<std::string>& measured) {
  const auto is_of = [&](const std::string& name) {
    return name == "elements" || name == "picture" ? limits.is_of(name) : limits.is_of("receiver", name);
  };
  if (limits.of.empty() || std::ranges::any_of(measured, is_of)) return;
  throw InputError(
      fmt::format("--target-of {}: no such thing is measured here ({})", limits.of,
                  measured.empty() ? "nothing is" : fmt::format("known: {}", fmt::join(measured, ", "))));
}

void check_photon_options(const PhotonOptions& options) {
  check_error_limits(options.limits.error);
  check_time(options.limits.seconds);
  check_receivers(options.run);
  if (!(options.run.checkpoint_every > 0)) throw InputError("--checkpoint-every must be above 0 seconds");
  if (!options.changed_from.empty()) {
    if (!options.run.resume)
      throw InputError("--changed-from renews kept photons: add --resume, and the folder of photons.tally");
    if (options.sequence != Sequence::halton)
      throw InputError("--changed-from needs --sequence halton: only its points come again alike, in groups");
    if (!options.elements.empty())
      throw InputError(
          "--changed-from makes the elements of both scenes alike: leave --elements out, and give "
          "--max-edge");
    if (options.limits.error.are_set() || options.limits.received)
      throw InputError(
          "--changed-from ends when all photons have gone again: give --time or --photons for an earlier "
          "end, "
          "no error and no --received");
  } else if (options.groups) {
    throw InputError("--groups is of --changed-from alone");
  }
  if (const std::string refused = refused_photons({{options.sequence, options.seed}, options.limits});
      !refused.empty())
    throw InputError(refused);
}

}  // namespace fluxel

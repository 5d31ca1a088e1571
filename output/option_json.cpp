#include "output/option_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/option_names.hpp"
#include "core/options.hpp"
#include "method/idle_options.hpp"
#include "method/methods.hpp"

namespace fluxel {

namespace {

/// By names as Python and scene files have them.
Json with_underscores(const Json& options) {
  Json json = Json::object();
  for (const auto& [name, value] : options.items()) {
    std::string key = name;
    std::ranges::replace(key, '-', '_');
    json[key] = value;
  }
  return json;
}

std::string form_factor_text(const FormFactorOptions& options) {
  if (options.rule == FormFactor::points)
    return fmt::format("points:{}x{}", options.points.m, options.points.n);
  return name_of(kRuleNames, options.rule);
}

Json tolerance_json(const Options& options) {
  if (options.tolerance) return *options.tolerance;
  if (!row_of(options.method).has_tolerance_of_share) return "auto";
  return fmt::format("auto:{}", options.discretisation_share);
}

/// Without a picture nothing tells what the camera sees.
Oracle oracle_in_force(const Options& options) {
  const bool has_picture = options.camera && !options.thermal;
  return options.oracle == Oracle::all && !has_picture ? Oracle::power : options.oracle;
}

void add_camera(const Camera& camera, Json& json) {
  if (!camera.name.empty()) json["camera"] = camera.name;
  json["eye"] = triple(camera.eye);
  json["look-at"] = triple(camera.look_at);
  json["up"] = triple(camera.up);
  json["fov"] = camera.fov;
  json["resolution"] = {camera.width, camera.height};
}

void add_picture(const Options& options, Json& json) {
  add_camera(*options.camera, json);
  if (!options.antialias) json["supersample"] = options.supersample;
  if (options.median_radius > 0) json["filter"] = fmt::format("median:{}", options.median_radius);
}

/// Of the picture and of the colours of elements.
void add_tone(const Options& options, Json& json) {
  if (options.exposure) json["exposure"] = *options.exposure;
  json["tone"] = name_of(kToneNames, options.tone);
}

void add_scene(const Options& options, Json& json) {
  json["scene"] = options.scene;
  if (options.metres_per_unit) json["metres-per-unit"] = *options.metres_per_unit;
  json["sides"] = name_of(kSidesNames, options.sides);
  json["thermal"] = options.thermal;
  json["ke"] = name_of(kKeNames, options.ke);
  json["textures"] = name_of(kTexturesNames, options.textures);
  json["no-cut"] = !options.cut;
  json["keep-polygons"] = !options.merge;
}

void add_receivers(const Options& options, Json& json) {
  if (options.false_colour.max) json["false-colour-max"] = *options.false_colour.max;
  if (options.false_colour.decades) json["false-colour-decades"] = *options.false_colour.decades;
  json["maintenance-factor"] = options.maintenance_factor;
}

void add_checkpoint(const Options& options, Json& json) {
  if (!options.checkpoint.empty()) {
    json["checkpoint"] = options.checkpoint;
    json["checkpoint-every"] = options.checkpoint_every;
    json["resume"] = options.resume;
    json["visibility-only"] = options.visibility_only;
  }
  if (!options.reuse_visibility.empty()) json["reuse-visibility"] = options.reuse_visibility;
}

void add_form_factors(const FormFactorOptions& options, Json& json) {
  json["form-factor"] = form_factor_text(options);
  json["form-factor-tolerance"] = options.tolerance;
  json["no-partial-visibility"] = !options.partial_visibility;
  json["closure"] = options.closure;
}

/// `has_others`: limits of another kind.
void add_error_limits(const ErrorLimits& limits, bool has_others, Json& json) {
  if (limits.absolute_error) json["absolute-error"] = *limits.absolute_error;
  if (limits.target_error || !(limits.absolute_error || has_others))
    json["target-error"] = limits.target_error.value_or(kReferenceError);
  if (!limits.of.empty()) json["target-of"] = limits.of;
}

}  // namespace

Json options_json(const Options& options) {
  Json json{{"method", row_of(options.method).name},
            {"trace-every-pair", options.trace_every_pair},
            {"subdivision", name_of(kSubdivisionNames, options.subdivision)},
            {"solver", name_of(kSolverNames, options.solver)},
            {"tolerance", tolerance_json(options)},
            {"max-iterations", options.max_iterations},
            {"no-error-estimate", !options.error_estimate},
            {"audit", options.audit},
            {"error-of", name_of(kErrorOfNames, error_of(options))},
            {"preview", options.preview},
            {"dry-run", options.dry_run},
            {"timeline", options.timeline},
            {"keep-links", options.keep_links},
            {"isa", name_of(kIsaNames, options.isa)},
            {"device", name_of(kDeviceNames, options.device)},
            {"verify-device", options.verify_device},
            {"specular", name_of(kSpecularNames, options.specular)},
            {"subscenes", name_of(kSubscenesNames, options.subscenes)},
            {"oracle", name_of(kOracleNames, oracle_in_force(options))},
            {"exchange", name_of(kExchangeNames, options.exchange)},
            {"picture", name_of(kPictureNames, options.picture)}};
  if (!options.write.empty()) json["write"] = options.write;
  if (options.camera || options.method != Method::view) add_tone(options, json);
  add_scene(options, json);
  add_receivers(options, json);
  add_form_factors(options.form_factor, json);
  if (options.block_error) {
    json["block-error"] = *options.block_error;
  } else {
    json["target-error"] = options.target_error.value_or(kTargetError);
  }
  if (!options.solution.empty()) json["solution"] = options.solution;
  if (options.memory) json["memory"] = *options.memory;
  if (options.seconds) json["time"] = *options.seconds;
  add_checkpoint(options, json);
  if (!options.warm_start.empty()) json["warm-start"] = options.warm_start;
  if (options.max_edge) json["max-edge"] = *options.max_edge;
  if (options.mesh_max_edge) json["mesh-max-edge"] = *options.mesh_max_edge;
  if (options.lightmap_texel) json["lightmap-texel"] = *options.lightmap_texel;
  if (options.threads > 0) json["threads"] = options.threads;
  if (options.camera) add_picture(options, json);

  // What another method's options are set to has no part in this run, nor what has no effect.
  const MethodRow& method = row_of(options.method);
  Json in_force = Json::object();
  for (const auto& [name, value] : json.items())
    if ((!is_own_option(name) || method.knows(name)) && idle_reason(name, options).empty())
      in_force[name] = value;
  return with_underscores(in_force);
}

Json options_json(const ReferenceOptions& options) {
  Json json{{"seed", options.seed},
            {"sampling", name_of(kSamplingNames, options.sampling)},
            {"isa", name_of(kIsaNames, options.run.isa)},
            {"device", name_of(kDeviceNames, options.run.device)}};
  if (options.run.device != Device::cpu) json["verify-device"] = options.run.verify_device;
  add_scene(options.run, json);
  json["specular"] = name_of(kFollowNames, options.run.specular);
  for (const char* const name : {"ke", "textures"})
    if (!idle_reason(name, options.run).empty()) json.erase(name);
  add_receivers(options.run, json);
  const ReferenceLimits& limits = options.limits;
  if (limits.seconds) json["time"] = *limits.seconds;
  if (limits.rays) json["rays"] = *limits.rays;
  add_error_limits(limits.error, limits.seconds || limits.rays, json);
  if (options.only != Measured::all) json["only"] = name_of(kMeasuredNames, options.only);
  if (options.measures_elements()) json["elements"] = options.elements;
  if (options.run.threads > 0) json["threads"] = options.run.threads;
  if (options.measures_picture()) {
    add_camera(*options.run.camera, json);
    if (options.supersample > 0) json["supersample"] = options.supersample;
    if (options.run.exposure) json["exposure"] = *options.run.exposure;
    json["tone"] = name_of(kToneNames, options.run.tone);
  }
  return with_underscores(json);
}

Json options_json(const PhotonOptions& options) {
  const Options& run = options.run;
  const bool has_seed = options.sequence == Sequence::scrambled || options.sequence == Sequence::random;
  Json json{{"sequence", name_of(kSequenceNames, options.sequence)},
            {"specular", name_of(kFollowNames, run.specular)},
            {"isa", name_of(kIsaNames, run.isa)},
            {"checkpoint-every", run.checkpoint_every},
            {"resume", run.resume}};
  if (has_seed) json["seed"] = options.seed;
  add_scene(run, json);
  for (const char* const name : {"ke", "textures"})
    if (!idle_reason(name, run).empty()) json.erase(name);
  add_receivers(run, json);
  const PhotonLimits& limits = options.limits;
  if (limits.seconds) json["time"] = *limits.seconds;
  if (limits.photons) json["photons"] = *limits.photons;
  if (limits.received) json["received"] = *limits.received;
  add_error_limits(limits.error, limits.seconds || limits.photons || limits.received, json);
  if (options.only != Measured::all) json["only"] = name_of(kCountedNames, options.only);
  if (!options.elements.empty()) json["elements"] = options.elements;
  if (options.elements.empty() && run.max_edge) json["max-edge"] = *run.max_edge;
  if (!run.checkpoint.empty()) json["checkpoint"] = run.checkpoint;
  if (!options.changed_from.empty()) json["changed-from"] = options.changed_from;
  if (options.groups) json["groups"] = *options.groups;
  if (run.threads > 0) json["threads"] = run.threads;
  return with_underscores(json);
}

}  // namespace fluxel

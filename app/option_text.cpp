#include <fmt/format.h>

#include "app/command_line.hpp"
#include "app/option_names.hpp"
#include "app/option_values.hpp"

namespace fluxel {

std::vector<std::pair<std::string, std::string>> describe(const Options& options) {
  std::vector<std::pair<std::string, std::string>> text{
      {"scene", options.scene},
      {"sides", name_of(kSidesNames, options.sides)},
      {"thermal", options.thermal ? "true" : "false"},
      {"no-cut", options.cut ? "false" : "true"},
      {"keep-polygons", options.merge ? "false" : "true"},
      {"trace-every-pair", options.trace_every_pair ? "true" : "false"},
      {"subdivision", name_of(kSubdivisionNames, options.subdivision)},
      {"subscenes", name_of(kSubscenesNames, options.subscenes)},
      {"form-factor", form_factor_text(options.form_factor)},
      {"form-factor-tolerance", fmt::format("{}", options.form_factor.tolerance)},
      {"no-partial-visibility", options.form_factor.partial_visibility ? "false" : "true"},
      {"closure", options.form_factor.closure ? "true" : "false"},
      {"solver", name_of(kSolverNames, options.solver)},
      {"tolerance", tolerance_text(options)},
      {"max-iterations", fmt::format("{}", options.max_iterations)},
      {"no-error-estimate", options.error_estimate ? "false" : "true"},
      {"preview", options.preview ? "true" : "false"},
      {"isa", name_of(kIsaNames, options.isa)},
      {"device", name_of(kDeviceNames, options.device)},
      {"verify-device", fmt::format("{}", options.verify_device)},
  };
  text.emplace_back("method", name_of(kMethodNames, options.method));
  if (options.method == Method::hierarchical) {
    text.emplace_back("oracle", name_of(kOracleNames, options.oracle));
    if (options.block_error) {
      text.emplace_back("block-error", fmt::format("{}", *options.block_error));
    } else {
      text.emplace_back("target-error", fmt::format("{}", options.target_error.value_or(kTargetError)));
    }
    if (options.memory) text.emplace_back("memory", fmt::format("{}", *options.memory));
  }
  if (!options.thermal) text.emplace_back("ke", name_of(kKeNames, options.ke));
  if (!options.checkpoint.empty()) {
    text.emplace_back("checkpoint", options.checkpoint);
    text.emplace_back("checkpoint-every", fmt::format("{}", options.checkpoint_every));
    text.emplace_back("resume", options.resume ? "true" : "false");
    text.emplace_back("visibility-only", options.visibility_only ? "true" : "false");
  }
  if (!options.reuse_visibility.empty()) text.emplace_back("reuse-visibility", options.reuse_visibility);
  if (!options.warm_start.empty()) text.emplace_back("warm-start", options.warm_start);
  if (options.max_edge) text.emplace_back("max-edge", fmt::format("{}", *options.max_edge));
  if (options.threads > 0) text.emplace_back("threads", fmt::format("{}", options.threads));
  if (options.camera) {
    const auto vector = [](const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); };
    const Camera& camera = *options.camera;
    text.emplace_back("eye", vector(camera.eye));
    text.emplace_back("look-at", vector(camera.look_at));
    text.emplace_back("up", vector(camera.up));
    text.emplace_back("fov", fmt::format("{}", camera.fov));
    text.emplace_back("resolution", fmt::format("{}x{}", camera.width, camera.height));
    text.emplace_back("supersample", fmt::format("{}", options.supersample));
    if (options.filter.kind != PictureFilter::Kind::none)
      text.emplace_back(
          "filter",
          fmt::format("{}:{}", options.filter.kind == PictureFilter::Kind::median ? "median" : "gaussian",
                      options.filter.size));
    if (options.exposure) text.emplace_back("exposure", fmt::format("{}", *options.exposure));
  }
  return text;
}

}  // namespace fluxel

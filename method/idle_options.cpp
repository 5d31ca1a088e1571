#include "method/idle_options.hpp"

#include <array>

#include "core/options.hpp"
#include "method/bake.hpp"
#include "method/bake_mesh.hpp"

namespace fluxel {

namespace {

/// When an option has no effect, and why.
struct IdleOption {
  std::string_view option;
  bool (*idle)(const Options&);
  std::string_view why;
};

bool is_not_adaptive(const Options& options) { return options.form_factor.rule != FormFactor::adaptive; }
bool keeps_nothing(const Options& options) { return options.checkpoint.empty(); }
bool has_no_camera(const Options& options) { return !options.camera; }
bool is_view_of_receivers(const Options& options) {
  return options.method == Method::view && !options.camera;
}
bool has_no_rasters(const Options& options) { return options.subdivision != Subdivision::camera; }
bool has_rasters(const Options& options) { return !has_no_rasters(options); }
bool is_view_of_elements(const Options& options) {
  return options.method == Method::view && options.picture == PictureFrom::elements;
}
bool has_no_device(const Options& options) { return options.device == Device::cpu; }
bool is_thermal(const Options& options) { return options.thermal; }
bool is_by_rays(const Options& options) { return options.exchange == ExchangeBy::rays; }
bool writes_no_light_map(const Options& options) {
  return options.lightmap_texel && !options.writes("lightmap");
}
bool writes_no_mesh(const Options& options) { return options.mesh_max_edge && !bakes_mesh(options); }
bool is_view_of_no_mesh(const Options& options) {
  return options.method == Method::view && !bakes(options) && !options.writes("false-colour");
}
bool is_dry(const Options& options) { return options.dry_run; }
bool computes_nothing(const Options& options) { return options.dry_run && options.method == Method::matrix; }
bool ends_with_visibility(const Options& options) { return options.visibility_only; }

constexpr std::string_view kNoTolerance = "only --form-factor adaptive has a tolerance";
constexpr std::string_view kNoPartial = "only --form-factor adaptive examines partly visible pairs";
constexpr std::string_view kReceiversAlone =
    "without a camera a view has no picture whose error could be judged";
constexpr std::string_view kNoPictureRays = "without rays that gather a picture GPUs have nothing to do";
constexpr std::string_view kDry = "a dry run ends with its forecast";
constexpr std::string_view kVisibility = "with --visibility-only nothing is solved";

constexpr std::array kIdleOptions{
    IdleOption{"ke", is_thermal, "with --thermal materials emit by their temperature"},
    IdleOption{"textures", is_thermal, "with --thermal reflectance follows from the emissivity"},
    IdleOption{"checkpoint-every", keeps_nothing, "without --checkpoint nothing is kept"},
    IdleOption{"target-error", is_view_of_receivers, kReceiversAlone},
    IdleOption{"audit", is_view_of_receivers, kReceiversAlone},
    IdleOption{"picture", has_no_camera, "without a camera there is no picture"},
    IdleOption{"picture", computes_nothing, kDry},
    IdleOption{"picture", ends_with_visibility, kVisibility},
    IdleOption{"picture", has_rasters, "elements that the camera makes are as fine as its pixels"},
    IdleOption{"subscenes", has_no_camera, "without a camera there are no rasters"},
    IdleOption{"subscenes", has_no_rasters,
               "elements of another --subdivision than camera do not depend on rasters"},
    IdleOption{"form-factor-tolerance", is_not_adaptive, kNoTolerance},
    IdleOption{"no-partial-visibility", is_not_adaptive, kNoPartial},
    IdleOption{"verify-device", has_no_device, "without --device cuda or auto there is nothing to verify"},
    IdleOption{"solver", is_by_rays,
               "rows of rays are not symmetric: with --exchange rays Jacobi's iteration solves"},
    IdleOption{"warm-start", is_dry, kDry},
    IdleOption{"preview", is_dry, kDry},
    IdleOption{"timeline", is_dry, kDry},
    IdleOption{"live", is_dry, kDry},
    IdleOption{"time", is_dry, kDry},
    IdleOption{"keep-links", is_dry, kDry},
    IdleOption{"keep-links", is_thermal, "with --thermal there is no light to view"},
    IdleOption{"keep-links", is_by_rays, "with --exchange rays there are no links"},
    IdleOption{"checkpoint", is_dry, kDry},
    IdleOption{"checkpoint-every", is_dry, kDry},
    IdleOption{"resume", is_dry, kDry},
    IdleOption{"reuse-visibility", is_dry, kDry},
    IdleOption{"solver", computes_nothing, kDry},
    IdleOption{"tolerance", computes_nothing, kDry},
    IdleOption{"max-iterations", computes_nothing, kDry},
    IdleOption{"closure", is_dry, kDry},
    IdleOption{"no-error-estimate", is_dry, kDry},
    IdleOption{"audit", computes_nothing, kDry},
    IdleOption{"visibility-only", is_dry, kDry},
    IdleOption{"device", is_view_of_receivers, kNoPictureRays},
    IdleOption{"device", is_view_of_elements, kNoPictureRays},
    IdleOption{"verify-device", is_view_of_receivers, kNoPictureRays},
    IdleOption{"verify-device", is_view_of_elements, kNoPictureRays},
    IdleOption{"device", is_dry, kDry},
    IdleOption{"verify-device", is_dry, kDry},
    IdleOption{"mesh-max-edge", is_dry, kDry},
    IdleOption{"lightmap-texel", is_dry, kDry},
    IdleOption{"write", is_dry, kDry},
    IdleOption{"write", is_view_of_no_mesh, "a view writes no meshes but those of --mesh-max-edge"},
    IdleOption{"filter", is_dry, kDry},
    IdleOption{"exposure", is_dry, kDry},
    IdleOption{"tone", is_dry, kDry},
    IdleOption{"warm-start", ends_with_visibility, kVisibility},
    IdleOption{"preview", ends_with_visibility, kVisibility},
    IdleOption{"solver", ends_with_visibility, kVisibility},
    IdleOption{"tolerance", ends_with_visibility, kVisibility},
    IdleOption{"max-iterations", ends_with_visibility, kVisibility},
    IdleOption{"closure", ends_with_visibility, kVisibility},
    IdleOption{"no-error-estimate", ends_with_visibility, kVisibility},
    IdleOption{"audit", ends_with_visibility, kVisibility},
    IdleOption{"mesh-max-edge", ends_with_visibility, kVisibility},
    IdleOption{"lightmap-texel", ends_with_visibility, kVisibility},
    IdleOption{"lightmap-texel", writes_no_light_map, "without --write lightmap no light map is written"},
    IdleOption{"mesh-max-edge", writes_no_mesh,
               "without --write vtu or glb no mesh is written but the elements"},
    IdleOption{"write", ends_with_visibility, kVisibility},
    IdleOption{"filter", ends_with_visibility, kVisibility},
    IdleOption{"exposure", ends_with_visibility, kVisibility},
    IdleOption{"tone", ends_with_visibility, kVisibility}};

}  // namespace

std::string_view idle_reason(std::string_view option, const Options& options) {
  for (const IdleOption& row : kIdleOptions)
    if (row.option == option && row.idle(options)) return row.why;
  return {};
}

}  // namespace fluxel

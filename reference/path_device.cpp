#include "reference/path_device.hpp"

#include "visibility/cuda/first_side.hpp"
#include "visibility/device_scene.hpp"

namespace fluxel {

namespace {

cuda::Double3 plain(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

std::uint8_t flags_of(const FirstSide& first_side, const Scene& scene, PatchId patch) {
  const auto flag = [](bool is_set, std::uint8_t bit) { return is_set ? bit : std::uint8_t{0}; };
  const std::uint32_t sides = scene.patch(patch).sides;
  return static_cast<std::uint8_t>(
      flag((sides & kFront) != 0, cuda::kActiveFront) | flag((sides & kBack) != 0, cuda::kActiveBack) |
      flag(scene.emits(patch), cuda::kEmitter) | flag(first_side.is_covered(patch), cuda::kCovered) |
      flag(scene.patch(patch).covers_emitter, cuda::kCoversEmitter) |
      flag(scene.material(scene.patch(patch)).sides == Sides::two, cuda::kTwoSided));
}

}  // namespace

cuda::PathArrays path_arrays(const RayScene& ray_scene) {
  const Scene& scene = ray_scene.scene();
  const FirstSide first_side(ray_scene);
  const Emitters emitters(scene);
  cuda::PathArrays arrays{device_scene(ray_scene, {}), {}, {}, {}, emitters.ends(), {sobol_directions()}};
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const PatchId patch{static_cast<std::uint32_t>(i)};
    arrays.flags.push_back(flags_of(first_side, scene, patch));
    for (const bool front : {true, false}) {
      const SideLight side = side_light(scene, patch, front);
      arrays.sides.push_back({plain(side.rho), plain(side.E)});
    }
  }
  for (const EmittingSide& side : emitters.sides()) {
    cuda::EmittingSide& emitter = arrays.emitters.emplace_back();
    for (std::uint32_t c = 0; c < side.outline.corners; ++c)
      emitter.corner[c] = plain(side.outline.corner[c]);
    emitter.normal = plain(side.normal);
    emitter.E = plain(side.E);
    emitter.corners = side.outline.corners;
  }
  return arrays;
}

cuda::PathBegin path_begin(const PathStart& start) {
  return {plain(start.at.position),
          plain(start.at.normal),
          {start.light[0], start.light[1]},
          start.numbers.state()};
}

}  // namespace fluxel

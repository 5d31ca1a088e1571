#include "method/measured_heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/options.hpp"
#include "core/sampling.hpp"
#include "method/finished_elements.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/reference_job.hpp"
#include "reference/light_paths.hpp"
#include "reference/sensor_starts.hpp"
#include "scene/piece_draw.hpp"

namespace fluxel {

namespace {

/// Of the target error: standard error of what is absorbed, as net heat is a difference of two powers; and
/// rays at most, some seconds of a processor.
constexpr double kShareOfNet = 0.1;
constexpr std::uint64_t kMostHeatRays = 20'000'000;

/// Standard errors that are stated beyond what is found off.
constexpr double kHeatWidth = 2;

/// The faces of a group, of given temperatures, that send on one side.
struct HeatSide {
  std::uint32_t group = 0;
  bool back = false;
  PieceDraw pieces;
  double absorbed = 0;  ///< by the solution [W]
};

double absorptance(const Scene& scene, PatchId patch) {
  const ThermalSurface& surface = *scene.material(scene.patch(patch)).thermal;
  return surface.emissivity.at(*surface.temperature);
}

/// By group, fronts first.
std::vector<HeatSide> heat_sides(const Scene& scene, const ElementView& mesh, std::span<const Rgb> H) {
  std::map<std::pair<std::uint32_t, bool>, HeatSide> sides;
  const auto has_temperature = [&](PatchId id) {
    return scene.material(scene.patch(id)).thermal->temperature.has_value();
  };
  for (const Piece& piece : scene.pieces) {
    if (!has_temperature(piece.patch)) continue;
    const Patch& patch = scene.patch(piece.patch);
    for (const bool back : {false, true}) {
      if ((patch.sides & (back ? kBack : kFront)) == 0) continue;
      const auto group = static_cast<std::uint32_t>(patch.group);
      HeatSide& side = sides[{group, back}];
      side.group = group;
      side.back = back;
      side.pieces.add(piece);
    }
  }
  const std::size_t count = mesh.elements.size();
  for (std::size_t i = 0; i < H.size(); ++i) {
    const PatchId id = mesh.elements[i % count].patch;
    if (!has_temperature(id)) continue;
    const auto found = sides.find({static_cast<std::uint32_t>(scene.patch(id).group), i >= count});
    if (found != sides.end())
      found->second.absorbed +=
          static_cast<double>(mesh.elements[i % count].area) * absorptance(scene, id) * H[i].r;
  }
  std::vector<HeatSide> list;
  list.reserve(sides.size());
  for (auto& [key, side] : sides) list.push_back(std::move(side));
  return list;
}

/// What is absorbed, mean over the faces of each side [W/m2].
class HeatSensors final : public SurfaceSensors {
 public:
  HeatSensors(const LightPaths& paths, const Scene& scene, std::span<const HeatSide> sides)
      : SurfaceSensors(paths), scene_(scene), sides_(sides) {}

  [[nodiscard]] std::size_t size() const override { return sides_.size(); }
  [[nodiscard]] double weight(std::size_t sensor) const override { return sides_[sensor].pieces.area(); }
  [[nodiscard]] bool may_show_nothing() const override { return false; }
  [[nodiscard]] bool has_light() const override { return light_paths().has_light(); }

 private:
  [[nodiscard]] SensorStart start_at(std::size_t sensor, const std::array<double, 4>& even,
                                     OwenSobol& numbers) const override {
    const auto [s, t, u, v] = even;
    const HeatSide& side = sides_[sensor];
    const auto [piece, rest] = side.pieces.draw(s);
    const glm::dvec3& normal = scene_.patch(piece.patch).normal;
    return {{{surface_point(piece.outline, rest, t), side.back ? -normal : normal}, {u, v}, numbers},
            Rgb(0),
            Rgb(absorptance(scene_, piece.patch))};
  }

  const Scene& scene_;
  std::span<const HeatSide> sides_;
};

}  // namespace

void measure_heat(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                  Solution& solution) {
  const Scene& scene = problem.scene;
  if (problem.options.audit == 0 || std::ranges::any_of(scene.materials, &Material::has_convection) ||
      !std::ranges::all_of(H, [](const Rgb& of) { return std::isfinite(of.r); }))
    return;
  const std::vector<HeatSide> sides = heat_sides(scene, mesh, H);
  if (sides.empty()) return;
  const ElementFinder finder(mesh);
  const FinishedElements light(finder, mesh, reflected_light(scene, mesh, H));
  const LightPaths paths(problem.ray_scene, &light);
  PathGoal goal;
  goal.limits.error.target_error = kShareOfNet * problem.options.target_error.value_or(kTargetError);
  goal.limits.rays = kMostHeatRays;
  goal.is_asked_for = false;
  problem.progress.begin("net heat");
  const ReferenceResult found =
      measure(problem.world, HeatSensors(paths, scene, sides), 0, goal, problem.threads, problem.progress);
  problem.progress.end();
  solution.stopped = solution.stopped || found.stopped;
  on_root(problem.world, [&] {
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const HeatSide& side = sides[k];
      const double area = side.pieces.area();
      const double off = std::abs(area * found.sensors[k].mean.r - side.absorbed);
      const double error = off + kHeatWidth * area * found.sensors[k].error.r;
      const auto row = std::ranges::find_if(solution.thermal, [&](const ThermalRow& of) {
        return of.group == scene.groups[side.group] && of.back == side.back;
      });
      if (row != solution.thermal.end()) row->error = std::max(row->error, error);
    }
    problem.log.say(
        fmt::format("net heat: measured by {:.3g} rays, standard error {:.2g} % of what is absorbed",
                    static_cast<double>(found.rays), 100 * found.relative_error.r));
  });
}

}  // namespace fluxel

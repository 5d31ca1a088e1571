#include "method/receiver_light.hpp"

#include <algorithm>
#include <cmath>

#include "method/handle_signals.hpp"
#include "method/measure_sensors.hpp"
#include "reference/light_paths.hpp"
#include "solver/channels.hpp"
#include "solver/unknowns.hpp"
#include "subdivision/element_finder.hpp"

namespace fluxel {

namespace {

/// Standard error of the gather, root mean square over the mean irradiance of a receiver: below what the
/// solution itself is off in most scenes.
constexpr double kGatherError = 2.5e-3;

/// What the elements of a mesh reflect.
class ElementLight final : public FinishedLight {
 public:
  ElementLight(const Scene& scene, const ElementView& mesh, std::span<const Rgb> H)
      : scene_(scene), mesh_(mesh), H_(H), finder_(mesh) {}

  [[nodiscard]] Rgb reflected(PatchId patch, bool front, const glm::dvec3& point) const override {
    const std::size_t element = finder_.find(patch, point);
    if (element == ElementFinder::kNone) return Rgb(0);
    const std::size_t unknown = front ? element : mesh_.elements.size() + element;
    return unknown < H_.size() ? scene_.material(scene_.patch(patch)).rho * H_[unknown] : Rgb(0);
  }

 private:
  const Scene& scene_;
  ElementView mesh_;
  std::span<const Rgb> H_;
  ElementFinder finder_;
};

}  // namespace

void gather_receivers(const Problem& problem, Solution& solution) {
  if (problem.sensors.receivers.empty()) return;
  Stopwatch watch;
  // One range, the root's.
  const bool has = problem.world.is_root() && solution.radiosity;
  const std::vector<Rgb> H =
      problem.world.all_gather(has ? std::span<const Rgb>(solution.radiosity->H) : std::span<const Rgb>());
  const ElementLight light(problem.scene, solution.subdivided.mesh, H);
  const LightPaths paths(problem.ray_scene, &light);
  PathGoal goal;
  goal.limits.target_error = kGatherError;
  for (const Receiver& receiver : problem.sensors.receivers) {
    handle_signals(problem.world, problem.options);
    SensorLight gathered =
        measure_sensors(problem, "receiver " + receiver.name, *cell_sensors(paths, receiver), goal);
    gathered.columns = receiver.columns;
    gathered.rows = receiver.rows;
    solution.sensors.push_back(std::move(gathered));
  }
  solution.time.gather.wall += watch.lap().wall;
}

double expected_error(const Solution& solution) {
  if (solution.hierarchy) {
    const HierarchyErrors& errors = solution.hierarchy->errors;
    return std::hypot(errors.discretisation.value_or(0), errors.iteration);
  }
  if (!solution.error_estimate || !solution.error_estimate->why_none.empty()) return 0;
  return std::hypot(largest_channel(solution.error_estimate->discretisation.error),
                    largest_channel(solution.radiosity->mean_square_bound));
}

}  // namespace fluxel

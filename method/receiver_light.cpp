#include "method/receiver_light.hpp"

#include <cstdint>

#include "method/measure_sensors.hpp"
#include "reference/light_paths.hpp"
#include "subdivision/element_finder.hpp"

namespace fluxel {

namespace {

/// Standard error of the gather, root mean square over the mean irradiance of a receiver: below what the
/// solution itself is off in most scenes.
constexpr double kGatherError = 2.5e-3;

/// Of a receiver: some seconds of a processor, where a small bright source makes the gather converge slowly.
constexpr std::uint64_t kMaxGatherRays = 30'000'000;

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

void gather_receivers(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                      Solution& solution) {
  Stopwatch watch;
  const ElementLight light(problem.scene, mesh, H);
  const LightPaths paths(problem.ray_scene, &light);
  PathGoal goal;
  goal.limits.target_error = kGatherError;
  goal.limits.rays = kMaxGatherRays;
  for (const Receiver& receiver : problem.sensors.receivers) {
    SensorLight gathered =
        measure_sensors(problem, Measured::receivers, receiver.name, *cell_sensors(paths, receiver), goal);
    gathered.columns = receiver.columns;
    gathered.rows = receiver.rows;
    // What has been solved is not thrown away for a signal.
    const bool stopped = gathered.measured.stopped;
    if (stopped) problem.log.warn("a signal has ended the gather of receivers at '" + receiver.name + "'");
    solution.sensors.push_back(std::move(gathered));
    if (stopped) break;
  }
  const PhaseTime time = watch.lap();
  solution.time.gather.wall += time.wall;
  solution.time.gather.processor += time.processor;
}

}  // namespace fluxel

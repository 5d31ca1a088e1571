#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/element.hpp"
#include "reference/light_paths.hpp"

namespace fluxel {

/// A path that starts at a sensor.
struct SensorPath {
  std::size_t sensor = 0;
  OwenSobol numbers;
};

/// Places where light is measured, each by many paths that start there.
class Sensors {
 public:
  virtual ~Sensors() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// What a sensor counts for in means: an area, or 1; 0 where there is nothing to measure.
  [[nodiscard]] virtual double weight(std::size_t sensor) const = 0;
  /// Whether anything shines in the scene: where nothing does, that no path finds light is no matter of luck.
  [[nodiscard]] virtual bool has_light() const = 0;
  /// Whether a sensor may have nothing to find, as a pixel that shows the dark does.
  [[nodiscard]] virtual bool may_show_nothing() const { return true; }
  /// An estimate by each path, which is right on average; the rays are added. Paths are traced side by side:
  /// some hundred at once take half the time that they would one by one.
  virtual void measure(std::span<const SensorPath> paths, std::span<Rgb> found,
                       std::uint64_t& rays) const = 0;
};

/// Where a sensor's path comes to a surface, and what the sensor has of the irradiance H that is found there
/// (of a sight: of what is found along it).
struct SensorStart {
  PathStart path;
  Rgb E{0};    ///< [W/m2]
  Rgb rho{1};  ///< or the share of H that is transmitted evenly
  double divisor = 1;
  std::size_t number = 0;  ///< among the paths that were asked for

  /// Of H [W/m2], in the sensor's unit.
  [[nodiscard]] Rgb value(const Rgb& H) const { return (E + rho * H) / divisor; }
};

/// Sensors whose paths are paths of light.
class PathSensors : public Sensors {
 public:
  /// The paths must outlive this.
  explicit PathSensors(const LightPaths& paths) : paths_(paths) {}

  /// Adds where each path starts; one that sees nothing starts nowhere and has found 0. Rays that this takes
  /// are added.
  virtual void start(std::span<const SensorPath> paths, std::vector<SensorStart>& started,
                     std::uint64_t& rays) const = 0;

  void measure(std::span<const SensorPath> paths, std::span<Rgb> found, std::uint64_t& rays) const final;
  /// Of what is known but for the light that surfaces send on.
  [[nodiscard]] bool has_light() const override { return paths_.has_light() && paths_.scatters(); }

 protected:
  [[nodiscard]] const LightPaths& light_paths() const { return paths_; }

 private:
  const LightPaths& paths_;
};

/// An element as a file gives it.
struct ElementShape {
  Outline<glm::dvec3> outline;  ///< recentred [m]
  PatchId patch = kNoPatch;
};

/// Mean radiosity [W/m2] of each element, what leaves it evenly: fronts, then, where any patch has an active
/// back, the backs. Sides that are not active weigh nothing. All that these functions are given must outlive
/// what they return.
[[nodiscard]] std::unique_ptr<PathSensors> element_sensors(const LightPaths& paths, const Scene& scene,
                                                           std::span<const ElementShape> elements);

/// Mean radiance of each pixel [W/m2/sr], row 0 at the top: over its whole area, or (`supersample` > 0) over
/// the centres of its supersample x supersample parts alone, which is what a solve's picture is made of.
[[nodiscard]] std::unique_ptr<PathSensors> pixel_sensors(const LightPaths& paths, const Scene& scene,
                                                         const Camera& camera, int supersample);

/// A place of a surface whose radiosity is measured.
struct SurfacePlace {
  LitPoint at;
  PatchId patch = kNoPatch;
  bool front = true;
  Rgb E{0};    ///< [W/m2]
  Rgb rho{1};  ///< what is measured is E + rho H, H being the irradiance
};

/// The radiosity of places [W/m2].
[[nodiscard]] std::unique_ptr<PathSensors> place_sensors(const LightPaths& paths,
                                                         std::span<const SurfacePlace> places);

}  // namespace fluxel

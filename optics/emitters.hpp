#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/element.hpp"
#include "core/rgb.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// What a side of a patch does with light.
struct SideLight {
  bool active = false;  ///< sends and receives; else it is black and dark
  Rgb rho{0};
  Rgb E{0};  ///< [W/m2]
  SurfaceOptics optics{};

  /// Whether it reflects evenly and does nothing else.
  [[nodiscard]] bool is_diffuse() const { return optics == SurfaceOptics{}; }
};

[[nodiscard]] SideLight side_light(const Scene& scene, PatchId id, bool front);

/// A point of an emitting side.
struct EmitterPoint {
  glm::dvec3 position{0};  ///< [m, recentred]
  glm::dvec3 normal{0};    ///< unit, to where it emits
  Rgb E{0};                ///< [W/m2]
  PatchId patch = kNoPatch;
  bool front = true;
};

/// An uncovered emitting side.
struct EmittingSide {
  Outline<glm::dvec3> outline;
  glm::dvec3 normal{0};  ///< unit, to where it emits
  Rgb E{0};              ///< [W/m2]
  PatchId patch = kNoPatch;
  bool front = true;
};

/// All uncovered emitting sides, to draw points of. A point's density depends on its exitance alone: it is
/// proportional to the sum of the channels' magnitudes.
class Emitters {
 public:
  explicit Emitters(const Scene& scene);

  [[nodiscard]] bool empty() const { return sides_.empty(); }

  /// A point from the unit square, u and v in [0, 1).
  [[nodiscard]] EmitterPoint point(double u, double v) const;

  /// The density [1/m2] with which a point of such an exitance is drawn.
  [[nodiscard]] double density(const Rgb& E) const;

  [[nodiscard]] const std::vector<EmittingSide>& sides() const { return sides_; }

  /// Running sums of the sides' area times magnitude; the last is the total.
  [[nodiscard]] const std::vector<double>& ends() const { return ends_; }

 private:
  std::vector<EmittingSide> sides_;
  std::vector<double> ends_;
};

}  // namespace fluxel

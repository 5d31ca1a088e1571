#include "optics/emitters.hpp"

#include <cmath>

#include "core/sampling.hpp"
#include "sampling/cuda/chosen_part.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

double magnitude(const Rgb& E) { return std::abs(E.r) + std::abs(E.g) + std::abs(E.b); }

}  // namespace

SideLight side_light(const Scene& scene, PatchId id, bool front) {
  const Patch& patch = scene.patch(id);
  if ((patch.sides & (front ? kFront : kBack)) == 0) return {};
  const Material& material = scene.material(patch);
  return {true, material.rho, front ? material.E : material.back_exitance(), material.optics};
}

Emitters::Emitters(const Scene& scene) {
  double sum = 0;
  for (const Piece& piece : scene.pieces)
    for (const bool front : {true, false}) {
      const SideLight side = side_light(scene, piece.patch, front);
      const double weight = magnitude(side.E) * area(corners(piece.outline));
      if (!(weight > 0)) continue;
      const glm::dvec3& normal = scene.patch(piece.patch).normal;
      sides_.push_back({piece.outline, front ? normal : -normal, side.E, piece.patch, front});
      ends_.push_back(sum += weight);
    }
}

EmitterPoint Emitters::point(double u, double v) const {
  const cuda::ChosenPart chosen = cuda::chosen_part(ends_.data(), ends_.size(), u);
  const EmittingSide& side = sides_[chosen.number];
  return {surface_point(side.outline, chosen.rest, v), side.normal, side.E, side.patch, side.front};
}

double Emitters::density(const Rgb& E) const { return sides_.empty() ? 0 : magnitude(E) / ends_.back(); }

}  // namespace fluxel

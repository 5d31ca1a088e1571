#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/receiver.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Whether photons can measure a receiver: irradiance over the cells of a grid. A single point none of them
/// meets, and of what does not follow from the flux through an area they know too little.
[[nodiscard]] inline bool is_counted(const Receiver& receiver) {
  return receiver.is_grid() && receiver.quantity == Quantity::irradiance;
}

/// Which cells of receivers a ray goes through, from the side that the normal points to.
class ReceiverCrossings {
 public:
  /// Receivers that are counted; cells are slots from `first_slot` on. A surface as near to a receiver as
  /// `contact` [m] lies in it.
  ReceiverCrossings(std::span<const Receiver> receivers, std::size_t first_slot, double contact);

  /// Calls take(receiver, slot) for each that the ray, its direction a unit vector, meets before it has gone
  /// `length` [m].
  template <class Take>
  void meet(const Ray& ray, double length, Take&& take) const {
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const Plane& of = planes_[k];
      const double towards = -glm::dot(of.normal, ray.direction);
      if (!(towards > 0)) continue;
      const double height = glm::dot(of.normal, ray.origin - of.origin);
      if (!(height > 0) || height > length * towards + contact_) continue;
      const glm::dvec3 at = ray.origin + height / towards * ray.direction - of.origin;
      const double s = glm::dot(at, of.across_u), t = glm::dot(at, of.across_v);
      if (!(s >= 0 && s < of.columns && t >= 0 && t < of.rows)) continue;
      // Row 0 is the last along v.
      const auto column = static_cast<std::size_t>(s), row = of.row_count - 1 - static_cast<std::size_t>(t);
      const std::size_t cell = row * of.column_count + column;
      if (of.receiver->measures(cell)) take(k, of.first_slot + cell);
    }
  }

 private:
  struct Plane {
    glm::dvec3 origin, normal;
    glm::dvec3 across_u, across_v;  ///< at . across_u is the column, at . across_v the row from below
    double columns, rows;
    std::size_t column_count, row_count, first_slot;
    const Receiver* receiver;
  };

  std::vector<Plane> planes_;
  double contact_;
};

}  // namespace fluxel

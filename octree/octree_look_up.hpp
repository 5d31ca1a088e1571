#pragma once

// Portable: what a device's compiler takes too (see visibility/cuda/portable.hpp).

#include <cstddef>
#include <vector>

#include "octree/octree_view.hpp"

namespace fluxel {

struct OctreePoint {
  double x, y, z;
};

/// Whether the sphere, its surface included, holds the point.
FLUXEL_PORTABLE inline bool holds(const Sphere& sphere, const OctreePoint& point) {
  const double x = point.x - sphere.x, y = point.y - sphere.y, z = point.z - sphere.z;
  return x * x + y * y + z * z <= static_cast<double>(sphere.radius) * sphere.radius;
}

/// The spheres that hold each of many points.
struct HoldingSpheres {
  std::vector<std::uint32_t> first;    ///< of each point, in `spheres`; one more at the end
  std::vector<std::uint32_t> spheres;  ///< numbers, ascending at each point
};

/// Look-ups of many points at once: each is counted first, then listed.
struct OctreeLookUp {
  OctreeView tree;
  const Sphere* spheres;
  const OctreePoint* points;
  std::uint32_t* first;  ///< of each point: spheres that hold it, then those of the points before it
  std::uint32_t* found;

  struct Count;
  struct List;
};

/// Of each point.
struct OctreeLookUp::Count {
  OctreeLookUp at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    const OctreePoint& point = at.points[k];
    std::uint32_t count = 0;
    at.tree.for_each_at(point.x, point.y, point.z,
                        [&](std::uint32_t s) { count += holds(at.spheres[s], point) ? 1 : 0; });
    at.first[k] = count;
  }
};
struct OctreeLookUp::List {
  OctreeLookUp at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    const OctreePoint& point = at.points[k];
    std::uint32_t place = at.first[k];
    at.tree.for_each_at(point.x, point.y, point.z, [&](std::uint32_t s) {
      if (holds(at.spheres[s], point)) at.found[place++] = s;
    });
  }
};

/// Looks all points up; returns how many spheres were found, in `found`, points being told apart by `first`.
/// `Machine`: see OctreeBuilder. At most 2^32 are found.
template <class Machine>
std::uint32_t look_up(Machine& machine, OctreeLookUp at, std::size_t points,
                      typename Machine::template Array<std::uint32_t>& first,
                      typename Machine::template Array<std::uint32_t>& found) {
  first = machine.template array<std::uint32_t>(points);
  at.first = first.data();
  machine.for_each(points, OctreeLookUp::Count{at});
  const std::uint32_t count = machine.sum_before(first, points);
  found = machine.template array<std::uint32_t>(count);
  at.found = found.data();
  machine.for_each(points, OctreeLookUp::List{at});
  return count;
}

}  // namespace fluxel

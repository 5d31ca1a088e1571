#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formfactor/surface_exchange.hpp"
#include "scene/scene_input.hpp"
#include "tests/closed_forms/cases.hpp"

namespace fluxel::bench {

/// Black polygons in groups, as files could hold them.
class Groups {
 public:
  Groups();

  /// The group's number.
  std::uint32_t add(const std::string& name, const std::vector<closed_forms::Polygon>& polygons);

  /// One-sided.
  [[nodiscard]] Scene scene() const;

 private:
  SceneInput input_;
};

/// All view factors of a scene, and what they took on this thread alone.
struct ViewFactors {
  std::vector<double> areas;               ///< of surfaces, by surface_of [m2]
  std::vector<SurfaceExchange> exchanges;  ///< from <= to, sorted
  std::uint64_t rays = 0;
  double seconds = 0;  ///< processor time, with the trees of patches

  [[nodiscard]] double factor(std::uint32_t from, std::uint32_t to) const;

  /// Sums of each group's factors.
  [[nodiscard]] std::vector<double> row_sums() const;
};

/// FacePairs over the whole scene, on one thread.
[[nodiscard]] ViewFactors find_view_factors(const Scene& scene, double tolerance);

/// The walls of a cube of that side about the origin, from outside, each in divisions x divisions squares.
[[nodiscard]] std::vector<closed_forms::Polygon> squares_of_cube(double side, int divisions);

}  // namespace fluxel::bench

#include "bench/view_factors/groups.hpp"

#include <algorithm>
#include <ctime>
#include <iterator>
#include <optional>
#include <utility>

#include "core/options.hpp"
#include "formfactor/view_factor_table.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel::bench {

namespace {

/// Of this thread alone: other programs' share of the core does not count [s].
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Groups::Groups() { input_.materials = {{"black", Rgb(0), Rgb(0), std::nullopt, std::nullopt}}; }

std::uint32_t Groups::add(const std::string& name, const std::vector<closed_forms::Polygon>& polygons) {
  const auto group = static_cast<std::uint32_t>(input_.groups.size());
  input_.groups.push_back(name);
  for (const closed_forms::Polygon& polygon : polygons)
    input_.polygons.push_back({polygon, MaterialId{0}, GroupId{group}});
  return group;
}

Scene Groups::scene() const {
  return build_scene(input_, {Sides::one, KeMeaning::exitance, true, std::nullopt});
}

double ViewFactors::factor(std::uint32_t from, std::uint32_t to) const {
  for (const SurfaceViewFactor& factor : view_factors_of({exchanges, areas}))
    if (factor.from == surface_of(from, false) && factor.to == surface_of(to, false)) return factor.value;
  return 0;
}

std::vector<double> ViewFactors::row_sums() const {
  const std::vector<double> sums = fluxel::row_sums({exchanges, areas});
  // One-sided: backs have no area.
  std::vector<double> of_fronts;
  for (std::size_t surface = 0; surface < sums.size(); surface += 2) of_fronts.push_back(sums[surface]);
  return of_fronts;
}

ViewFactors find_view_factors(const Scene& scene, double tolerance) {
  constexpr int kThreads = 1;
  const double start = processor_seconds();
  const RayScene ray_scene(scene, kThreads);
  const FacePairs pairs(ray_scene, scene, tolerance);
  ViewFactors found;
  for (std::size_t row = 0; row < pairs.rows(); ++row) {
    const SurfaceExchanges of_row = pairs.examine_row(row);
    std::ranges::copy(of_row.list, std::back_inserter(found.exchanges));
    found.rays += of_row.rays;
  }
  found.exchanges = sum_by_surfaces(std::move(found.exchanges));
  found.areas = pairs.surface_areas();
  found.seconds = processor_seconds() - start;
  return found;
}

std::vector<closed_forms::Polygon> squares_of_cube(double side, int divisions) {
  std::vector<closed_forms::Polygon> squares;
  for (const closed_forms::Polygon& wall : closed_forms::cube(glm::dvec3(0), side)) {
    const glm::dvec3 u = (wall[1] - wall[0]) / double(divisions), v = (wall[3] - wall[0]) / double(divisions);
    for (int i = 0; i < divisions; ++i)
      for (int j = 0; j < divisions; ++j) {
        const glm::dvec3 corner = wall[0] + double(i) * u + double(j) * v;
        squares.push_back({corner, corner + u, corner + u + v, corner + v});
      }
  }
  return squares;
}

}  // namespace fluxel::bench

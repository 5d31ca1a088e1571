#include "method/thermal.hpp"

#include <algorithm>
#include <cmath>

namespace fluxel {

namespace {

/// What an unknown exchanges, and bounds of the errors of q and H [W/m2].
struct HeatFlux {
  double H, q, H_error, q_error;
};

/// Rows of all groups, fronts and backs alternating, sums where means will be.
class Sums {
 public:
  explicit Sums(std::size_t groups) : rows_(2 * groups), black_exitance_(2 * groups) {}

  /// Of an unknown of `A` m2.
  void add(std::size_t row, const ThermalSurface& surface, double A, const HeatFlux& flux) {
    const double black = black_exitance(surface, flux.H);
    ThermalRow& sum = rows_[row];
    sum.area += A;
    sum.emissivity += A * surface.emissivity;
    sum.absorbed += A * surface.emissivity * flux.H;
    sum.net += A * flux.q;
    sum.error += A * flux.q_error;
    sum.below_zero = sum.below_zero || black + flux.H_error < 0;
    black_exitance_[row] += A * black;
  }

  [[nodiscard]] std::vector<ThermalRow> finish(const Scene& scene) && {
    std::vector<ThermalRow> found;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      ThermalRow& row = rows_[i];
      if (row.area == 0) continue;
      row.group = scene.groups[i / 2];
      row.back = i % 2 == 1;
      row.emissivity /= row.area;
      row.emitted = row.net + row.absorbed;
      row.temperature = temperature_of(black_exitance_[i] / row.area);
      found.push_back(std::move(row));
    }
    return found;
  }

 private:
  std::vector<ThermalRow> rows_;
  std::vector<double> black_exitance_;
};

}  // namespace

std::vector<ThermalRow> thermal_rows(const Scene& scene, std::span<const Element> elements,
                                     const Unknowns& unknowns, const Radiosity& radiosity,
                                     const RowSums& row_sums) {
  const double B_error = radiosity.error_bound * area_mean(unknowns, radiosity.B).r;
  Sums sums(scene.groups.size());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (unknowns.area[i] == 0) continue;
    const bool back = i >= elements.size();
    const Patch& patch = scene.patch(elements[back ? i - elements.size() : i].patch);
    const double H = radiosity.H[i].r, absorptance = 1 - unknowns.rho[i].r;
    const double H_error = row_sums.sums[i] * B_error + row_sums.rounding * H;
    // An unknown error times nothing is nothing: a prescribed flux is exact.
    const double q_error = absorptance > 0 ? absorptance * H_error : 0;
    sums.add(2 * index(patch.group) + (back ? 1 : 0), *scene.material(patch).thermal, unknowns.area[i],
             {H, unknowns.E[i].r - absorptance * H, H_error, q_error});
  }
  return std::move(sums).finish(scene);
}

}  // namespace fluxel

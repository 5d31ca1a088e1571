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
    const double black = black_exitance(surface, flux.H), eps = emissivity_of(surface, flux.H);
    ThermalRow& sum = rows_[row];
    sum.area += A;
    sum.emissivity += A * eps;
    sum.absorbed += A * eps * flux.H;
    sum.net += A * flux.q;
    // A side from which more is drawn than it gets at 0 K is no colder than that to the air.
    if (surface.has_convection())
      sum.convected += A * (black < 0 ? -surface.convection_coefficient * surface.air_temperature
                                      : surface.heat_flux - flux.q);
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
    const ThermalSurface& surface = *scene.material(patch).thermal;
    const double H = radiosity.H[i].r;
    const ThermalExchange exchange = linearised(surface, H);
    const double absorptance = 1 - exchange.rho;
    const double H_error = row_sums.sums[i] * B_error + row_sums.rounding * std::abs(H);
    // An unknown error times nothing is nothing: a prescribed flux is exact.
    const double q_error = absorptance > 0 ? absorptance * H_error : 0;
    sums.add(2 * index(patch.group) + (back ? 1 : 0), surface, unknowns.area[i],
             {H, exchange.E - absorptance * H, H_error, q_error});
  }
  return std::move(sums).finish(scene);
}

EnergyBalance thermal_balance(std::span<const Element> elements, std::span<const Material> materials,
                              Unknowns unknowns, const Radiosity& radiosity,
                              std::span<const SideSample> samples) {
  Rgb given(0), taken(0);  // by the air
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Material& material = materials[index(elements[i % elements.size()].material)];
    if (unknowns.area[i] == 0 || !material.has_convection()) continue;
    const ThermalSurface& surface = *material.thermal;
    const double power = unknowns.area[i] * (surface.heat_flux - net_flux(surface, radiosity.H[i].r));
    (power > 0 ? taken : given) += Rgb(std::abs(power));
    unknowns.E[i] = Rgb(surface.heat_flux);
    unknowns.rho[i] = Rgb(1);
  }
  EnergyBalance balance = energy_balance(unknowns, radiosity, samples, {});
  balance.emitted += given;
  balance.convected = taken;
  balance.defect += given - taken;
  return balance;
}

std::vector<Rgb> irradiance_by_materials(std::span<const Element> elements,
                                         std::span<const Material> materials, const Radiosity& radiosity) {
  std::vector<Rgb> H = radiosity.H;
  for (std::size_t i = 0; i < H.size(); ++i) {
    const Material& material = materials[index(elements[i % elements.size()].material)];
    if (material.has_convection()) H[i] = (radiosity.B[i] - material.E) / material.rho;
  }
  return H;
}

}  // namespace fluxel

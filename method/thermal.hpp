#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "core/material.hpp"
#include "method/energy.hpp"
#include "scene/scene.hpp"
#include "solver/error_bound.hpp"
#include "solver/iterate.hpp"
#include "solver/side_samples.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// The heat of all elements of a group on one side. Powers are sums, emissivity and the fourth power of the
/// temperature means weighted by area.
struct ThermalRow {
  std::string group;
  bool back = false;
  double area = 0;         ///< [m2]
  double temperature = 0;  ///< [K]; not a number where the mean of sigma T^4 is below 0
  double emissivity = 0;
  double emitted = 0;       ///< [W], eps sigma T^4
  double absorbed = 0;      ///< [W], eps H
  double net = 0;           ///< [W], emitted - absorbed: what the surface loses to the enclosure
  double convected = 0;     ///< [W], h (T - T_air): what it loses to the air
  double error = 0;         ///< [W], of the net heat: see thermal_rows and measure_heat
  bool below_zero = false;  ///< somewhere sigma T^4 is below 0 by more than its error bound
};

/// A row for every group and side that holds unknowns, in the order of the groups, fronts first.
///
/// The net flux q = E - (1 - rho) H is exact where it is prescribed (rho = 1). Elsewhere its error, of the
/// linear system alone, is 1 - rho times that of H (of a given temperature eps): the form factors' row sum
/// times the largest error of B, which the solve bounds, and the rounding of the product F B.
[[nodiscard]] std::vector<ThermalRow> thermal_rows(const Scene& scene, std::span<const Element> elements,
                                                   const Unknowns& unknowns, const Radiosity& radiosity,
                                                   const RowSums& row_sums);

/// The energy balance of a thermal solution. Of sides with convection what is given of their heat counts as
/// emitted or absorbed, as of others; what the air gives is emitted too, and what it takes is convected.
/// `unknowns` are those of the materials; `samples` as energy_balance has them.
[[nodiscard]] EnergyBalance thermal_balance(std::span<const Element> elements,
                                            std::span<const Material> materials, Unknowns unknowns,
                                            const Radiosity& radiosity, std::span<const SideSample> samples);

/// The irradiance of each unknown [W/m2] by which the scene's materials send what the solution says: that of
/// the solution, but of sides with convection.
[[nodiscard]] std::vector<Rgb> irradiance_by_materials(std::span<const Element> elements,
                                                       std::span<const Material> materials,
                                                       const Radiosity& radiosity);

}  // namespace fluxel

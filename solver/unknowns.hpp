#pragma once

#include <span>
#include <vector>

#include "core/element.hpp"
#include "core/material.hpp"
#include "core/rgb.hpp"

namespace fluxel {

/// The right-hand side of B = E + rho H0 + rho F B, one entry an unknown side: the fronts of all elements in
/// their order, then, where any element has an unknown back, the backs of all. Sides that are no unknowns
/// have rho = E = 0 and area 0.
struct Unknowns {
  std::size_t elements = 0;
  bool two_sided = false;
  std::size_t active = 0;  ///< sides that are unknowns
  std::vector<Rgb> E;      ///< [W/m2]
  std::vector<Rgb> rho;
  std::vector<double> area;  ///< [m2]
  std::vector<Rgb> H0;       ///< irradiance by luminaires [W/m2]; empty: there are none

  [[nodiscard]] std::size_t size() const { return E.size(); }
  /// What a side sends before any light has come from another: E + rho H0.
  [[nodiscard]] Rgb source(std::size_t i) const { return H0.empty() ? E[i] : E[i] + rho[i] * H0[i]; }
};

/// E + rho H0 of each.
[[nodiscard]] std::vector<Rgb> sources(const Unknowns& unknowns);

/// How many there are, without their values.
struct UnknownCount {
  bool two_sided = false;
  std::size_t active = 0;
};
[[nodiscard]] UnknownCount count_unknowns(std::span<const Element> elements);

[[nodiscard]] Unknowns make_unknowns(std::span<const Element> elements, std::span<const Material> materials);
/// Of a part of the elements, where those of the whole scene have unknown backs or have none.
[[nodiscard]] Unknowns make_unknowns(std::span<const Element> elements, std::span<const Material> materials,
                                     bool two_sided);

/// sum A_i x_i / sum A_i, for each colour, in the order of the entries; 0 where there is no area.
[[nodiscard]] Rgb area_mean(std::span<const double> area, std::span<const Rgb> x);
/// Over all of the unknowns.
[[nodiscard]] Rgb area_mean(const Unknowns& unknowns, std::span<const Rgb> x);

}  // namespace fluxel

#include "method/matrix_heat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/thermal.hpp"
#include "solver/linear_system.hpp"
#include "solver/reductions.hpp"

namespace fluxel {

namespace {

/// The sides of a rank's elements that have convection.
class ConvectiveSides {
 public:
  ConvectiveSides(std::span<const Element> elements, std::span<const Material> materials,
                  const Unknowns& unknowns) {
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const Material& material = materials[index(elements[i % elements.size()].material)];
      if (unknowns.area[i] == 0 || !material.has_convection()) continue;
      const ThermalSurface& surface = *material.thermal;
      sides_.push_back({i, &surface, temperature(surface, first_irradiance(surface))});
    }
  }

  /// What B = E + rho H of the unknowns is off at H, an entry an unknown.
  [[nodiscard]] std::vector<double> residual(const Unknowns& unknowns, std::span<const Rgb> H) const {
    std::vector<double> residual(unknowns.size(), 0);
    for (const Side& side : sides_) {
      const double at = H[side.unknown].r;
      const double B = at + net_flux(*side.surface, at);
      residual[side.unknown] = B - unknowns.E[side.unknown].r - unknowns.rho[side.unknown].r * at;
    }
    return residual;
  }

  /// Makes E and rho those of the tangents at H; returns the largest change of a temperature [K].
  [[nodiscard]] double linearise_at(std::span<const Rgb> H, Unknowns& unknowns) {
    double change = 0;
    for (Side& side : sides_) {
      const ThermalExchange tangent = linearised(*side.surface, H[side.unknown].r);
      unknowns.E[side.unknown] = Rgb(tangent.E);
      unknowns.rho[side.unknown] = Rgb(tangent.rho);
      const double before = std::exchange(side.temperature, temperature(*side.surface, H[side.unknown].r));
      change = std::max(change, std::abs(side.temperature - before));
    }
    return change;
  }

 private:
  struct Side {
    std::size_t unknown;
    const ThermalSurface* surface;
    double temperature;  // [K]
  };

  static double temperature(const ThermalSurface& surface, double H) {
    return temperature_of(std::max(0.0, black_exitance(surface, H)));
  }

  std::vector<Side> sides_;
};

/// Bounds, over the area-mean of B, of what a residual leaves; of its largest entry alone where no bound is
/// known.
ErrorBound<double> relative_bound(RadiosityOperator& F, const LinearSolution& found, const Unknowns& unknowns,
                                  std::span<const double> residual) {
  const auto system = make_system<double>(F, unknowns);
  std::vector<double> B;
  for (const Rgb& of : found.radiosity.B) B.push_back(of.r);
  const double mean = system.area_mean(B);
  if (found.row_sums.weights) {
    const ErrorBound<double> bound =
        error_bound<double>(found.row_sums, system, residual, ChangeKind::residual);
    return {bound.largest / mean, bound.mean_square / mean};
  }
  double most = 0;
  for (const double of : residual) most = std::max(most, std::abs(of));
  most = largest_over(F.ranks(), most) / mean;
  return {most, most};
}

void end_unfinished(const HeatSteps& steps, Radiosity& radiosity) {
  radiosity.converged = false;
  radiosity.cause = fmt::format(
      "after {} steps the temperatures of faces with convection still change by up to {:.2g} K; where an "
      "emissivity changes steeply with the temperature several may fit: let it change less steeply",
      steps.steps, steps.change);
}

}  // namespace

bool has_convection(std::span<const Element> elements, std::span<const Material> materials) {
  return std::ranges::any_of(elements, [&](const Element& element) {
    return element.sides != 0 && materials[index(element.material)].has_convection();
  });
}

LinearSolution solve_heat(RadiosityOperator& F, std::span<const Element> elements,
                          std::span<const Material> materials, Unknowns unknowns, std::span<const Rgb> start,
                          const LinearSolver& solve, HeatSteps& steps) {
  ConvectiveSides sides(elements, materials, unknowns);
  std::vector<Rgb> B(start.begin(), start.end());
  int iterations = 0;
  while (true) {
    LinearSolution found = solve(unknowns, B);
    Radiosity& radiosity = found.radiosity;
    radiosity.iterations = iterations += radiosity.iterations;
    ++steps.steps;
    const ErrorBound<double> left = relative_bound(F, found, unknowns, sides.residual(unknowns, radiosity.H));
    steps.change = largest_over(F.ranks(), sides.linearise_at(radiosity.H, unknowns));
    steps.error = left.largest;
    const bool is_done = !radiosity.converged || steps.error <= kHeatTolerance;
    if (is_done || steps.steps == kMostHeatSteps) {
      radiosity.largest_bound += Rgb(left.largest);
      radiosity.mean_square_bound += Rgb(left.mean_square);
      radiosity.error_bound += left.largest;
      if (!is_done) end_unfinished(steps, radiosity);
      return found;
    }
    B = std::move(radiosity.B);
  }
}

}  // namespace fluxel

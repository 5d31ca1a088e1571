#pragma once

#include <functional>
#include <span>
#include <string>

#include "core/element.hpp"
#include "core/material.hpp"
#include "solver/error_bound.hpp"
#include "solver/iterate.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// Of the area-mean of B, by its error bound: what the steps may leave. They converge quadratically, so that
/// it costs one at most.
inline constexpr double kHeatTolerance = 1e-6;

/// Of well-behaved surfaces four or five suffice.
inline constexpr int kMostHeatSteps = 50;

/// How the temperatures of faces with convection were found: by linear solves, each about the temperatures of
/// the one before.
struct HeatSteps {
  int steps = 0;
  double change = 0;  ///< of any such face's temperature by the last step, the largest [K]
  double error = 0;   ///< bound, to first order, of what the steps leave of max |B - B*| over the area-mean
};

/// The solution of a linear system: this rank's part of it, as Radiosity and RowSums have it.
struct LinearSolution {
  Radiosity radiosity;
  RowSums row_sums;
  std::string solver_reason;  ///< of Solver::automatic
};

/// Collective: solves B = E + rho F B of these unknowns, from `start` where it is not empty.
using LinearSolver = std::function<LinearSolution(const Unknowns& unknowns, std::span<const Rgb> start)>;

/// Whether any material in use has convection.
[[nodiscard]] bool has_convection(std::span<const Element> elements, std::span<const Material> materials);

/// Newton's method for faces whose B is no linear function of H (linearised in core/thermal.hpp), by all
/// ranks of F together. Each B(H) is convex and I - rho F an M-matrix, so that the steps converge from any
/// start, and from the first one on from below (Ortega & Rheinboldt, Iterative Solution of Nonlinear
/// Equations in Several Variables, 1970, theorem 13.3.4). Emissivities that change steeply may break the
/// convexity: where kMostHeatSteps do not suffice, the radiosity says that it has not converged. `elements`
/// are this rank's, `unknowns` theirs with the materials' E and rho. The solution is the last step's, with
/// the iterations of all, and its bounds hold for the nonlinear system too.
[[nodiscard]] LinearSolution solve_heat(RadiosityOperator& F, std::span<const Element> elements,
                                        std::span<const Material> materials, Unknowns unknowns,
                                        std::span<const Rgb> start, const LinearSolver& solve,
                                        HeatSteps& steps);

}  // namespace fluxel

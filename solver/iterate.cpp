#include "solver/iterate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solver/iteration.hpp"
#include "solver/step_history.hpp"
#include "solver/verdict.hpp"

namespace fluxel {

namespace {

std::string diverged_cause(const StopRule& stop, const RowSums& row_sums) {
  return fmt::format(
      "the iteration diverges: the largest row sum of the form factors is {:.4g}, and times the "
      "reflectance it amplifies; {}",
      row_sums.largest, stop.against_growth);
}

std::string indefinite_cause(const StopRule& stop, const RowSums& row_sums) {
  return fmt::format(
      "conjugate gradients broke down, because the system is not positive definite: the largest row sum "
      "of the form factors is {:.4g}, and times the reflectance it amplifies; {}",
      row_sums.largest, stop.against_growth);
}

std::string rounding_cause(double error_bound) {
  return fmt::format(
      "the iteration has come to the rounding of single precision, with an error bound of {:.2g}; ask "
      "for a larger --tolerance",
      error_bound);
}

std::string unfinished_cause(const Radiosity& result, const StopRule& stop, const RowSums& row_sums) {
  if (!row_sums.weights)
    return fmt::format(
        "after {} iterations no bound of the error is known, because the reflectance times the row sums "
        "of the form factors (largest {:.4g}) amplifies; {}",
        result.iterations, row_sums.largest, stop.against_growth);
  const std::string wanted = stop.discretisation == nullptr
                                 ? fmt::format("--tolerance {:g}", stop.tolerance)
                                 : fmt::format("{:g} of the discretisation error", stop.share);
  return fmt::format("{} iterations were not enough for {} (error bound {:.3g}); raise --max-iterations",
                     result.iterations, wanted, result.error_bound);
}

template <class Value>
std::unique_ptr<Iteration<Value>> make_iteration(Solver solver, const LinearSystem<Value>& system,
                                                 std::span<const Value> start) {
  switch (solver) {
    case Solver::jacobi:
      return make_jacobi(system, start);
    case Solver::gauss_seidel:
      return make_gauss_seidel(system, start);
    case Solver::southwell:
      return make_southwell(system, start);
    case Solver::conjugate_gradients:
      return make_conjugate_gradients(system, start);
    case Solver::automatic:
      break;
  }
  throw std::logic_error("the solver has to be chosen first");
}

/// The largest |E| of each channel.
template <class Value>
Value largest_emission(const LinearSystem<Value>& system) {
  Value most(0);
  for (const Value& E : system.E) most = glm::max(most, glm::abs(E));
  return largest_over(system.F.ranks(), most);
}

/// E, but where there is a start and light is reflected. What a colour had that has no light now would only
/// have to go again.
template <class Value>
std::vector<Value> start_of(const LinearSystem<Value>& system, std::span<const Rgb> start) {
  std::vector<Value> B = system.E;
  const Value emitted = largest_emission(system);
  const auto take = [](double given, double weight) { return weight > 0 ? given : 0; };
  for (std::size_t i = 0; i < start.size(); ++i) {
    Value given;
    if constexpr (kChannelsOf<Value> == 1) {
      given = start[i].r;
    } else {
      given = start[i];
    }
    const Value reflected = given - system.E[i];
    if (system.area[i] > 0) B[i] += by_channel(take, reflected, system.rho[i] * emitted);
  }
  return B;
}

/// A power of two near the largest emission of each channel: with it as unit of power, which changes no
/// digit, no square of a radiosity is too large or too small.
template <class Value>
Value unit_of_power(const LinearSystem<Value>& system) {
  const Value most = largest_emission(system);
  const auto power_of_two = [](double of, double) {
    return of > 0 && std::isfinite(of) ? std::ldexp(1.0, std::ilogb(of)) : 1.0;
  };
  return by_channel(power_of_two, most, most);
}

template <class Value>
std::vector<Rgb> in_watts(std::span<const Value> values, const Value& unit) {
  std::vector<Rgb> wide(values.size());
  std::ranges::transform(values, wide.begin(), [&](const Value& value) { return widened(value * unit); });
  return wide;
}

template <class Value>
Radiosity solve_in(Solver solver, const RadiositySystem& given, const StopRule& stop,
                   const IterationObserver& observer, std::span<const Rgb> start) {
  RadiosityOperator& F = given.F;
  const RowSums& row_sums = given.row_sums;
  LinearSystem<Value> system = make_system<Value>(F, given.unknowns);
  std::vector<Value> first = start_of(system, start);
  const Value unit = unit_of_power(system);
  for (std::size_t i = 0; i < system.size(); ++i) {
    system.E[i] /= unit;
    first[i] /= unit;
  }
  const std::unique_ptr<Iteration<Value>> method =
      make_iteration(solver, system, std::span<const Value>(first));
  std::vector<Value> H(system.size()), residual(system.size());
  const auto check = [&] {
    F.apply(method->radiosity(), std::span<Value>(H));
    system.residual_of(method->radiosity(), H, residual);
    return judge(system, row_sums, stop, method->radiosity(), std::span<const Value>(residual),
                 ChangeKind::residual);
  };

  Radiosity result;
  Verdict<Value> verdict, truth;
  StepHistory history(row_sums.weights ? row_sums.weights->contraction : 0);
  TrueErrorChecks checks;
  bool checked = false, stalled = false;
  while (result.iterations < stop.max_iterations) {
    method->advance();
    ++result.iterations;
    verdict = judge(system, row_sums, stop, method->radiosity(), method->change(), method->change_kind());
    history.add(verdict.largest_change, verdict.relative_change);
    for (int c = 0; c < kChannelsOf<Value>; ++c)
      if (verdict.is_enough(stop, c)) method->hold(c);
    checked = !method->change_is_exact() && verdict.is_enough(stop);
    if (checked) {
      verdict = truth = check();
      if (!verdict.is_enough(stop)) method->restart(method->radiosity(), residual);
      // The bounds of a step and of the residual after it may differ by more than such a gain.
      stalled = method->change_kind() == ChangeKind::residual && checks.stall(largest_channel(truth.largest));
    }
    result.error_bound = largest_channel(verdict.largest);
    const auto [error, target] = verdict.furthest(stop);
    observer({result.iterations, result.error_bound, error, target});

    result.converged = verdict.is_enough(stop);
    if (result.converged) break;
    // Where the bound shows that the system is positive definite and contracts, rounding is all that can be
    // the matter.
    const bool safe = row_sums.weights.has_value();
    if (!safe && method->broken_down()) {
      result.cause = indefinite_cause(stop, row_sums);
      break;
    }
    if (!std::isfinite(verdict.largest_change) || (!safe && history.diverged())) {
      result.cause = diverged_cause(stop, row_sums);
      break;
    }
    stalled = stalled || method->broken_down() || verdict.rounding_rules(stop) || history.stands_still();
    if (stalled) break;
  }
  if (!checked) truth = check();
  if (!method->change_is_exact()) verdict = truth;
  if (verdict.is_enough(stop)) {
    result.converged = true;
    result.cause.clear();
  }

  result.solver = solver;
  result.channels = kChannelsOf<Value>;
  result.B = in_watts(method->radiosity(), unit);
  result.H = in_watts(std::span<const Value>(H), unit);
  result.residual = truth.relative_change;
  result.error_bound = largest_channel(verdict.largest);
  result.largest_bound = widened(verdict.largest);
  result.mean_square_bound = widened(verdict.mean_square);
  if (stop.discretisation != nullptr) result.discretisation = widened(verdict.discretisation);
  result.tolerance = stop.tolerance;
  if (!result.converged && result.cause.empty()) {
    result.cause = row_sums.weights && stalled            ? rounding_cause(result.error_bound)
                   : !row_sums.weights && history.grows() ? diverged_cause(stop, row_sums)
                                                          : unfinished_cause(result, stop, row_sums);
  }
  return result;
}

}  // namespace

bool is_grey(const Ranks& ranks, const Unknowns& unknowns) {
  const auto coloured = [](const Rgb& value) { return value.r != value.g || value.g != value.b; };
  return !is_any(ranks, std::ranges::any_of(unknowns.E, coloured) ||
                            std::ranges::any_of(unknowns.rho, coloured) ||
                            std::ranges::any_of(unknowns.H0, coloured));
}

Radiosity solve_radiosity(Solver solver, const RadiositySystem& system, const StopRule& stop,
                          const IterationObserver& observer, std::span<const Rgb> start) {
  StopRule usable = stop;
  if (stop.discretisation != nullptr && !stop.discretisation->known()) usable.discretisation = nullptr;
  Radiosity found = system.F.is_grey() && is_grey(system.F.ranks(), system.unknowns)
                        ? solve_in<double>(solver, system, usable, observer, start)
                        : solve_in<Rgb>(solver, system, usable, observer, start);
  for (std::size_t i = 0; i < system.unknowns.H0.size(); ++i) found.H[i] += system.unknowns.H0[i];
  return found;
}

}  // namespace fluxel

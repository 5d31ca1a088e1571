#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solver/error_bound.hpp"
#include "solver/linear_system.hpp"

namespace fluxel {

/// An iterative method at work on one system, of which each rank has its own part of all vectors. All methods
/// give the same bytes for every number of ranks and threads where F.apply does; Gauss-Seidel where F.sweep
/// does.
template <class Value>
class Iteration {
 public:
  virtual ~Iteration() = default;

  /// One iteration.
  virtual void advance() = 0;

  /// The radiosity that has been come to [W/m2].
  [[nodiscard]] virtual std::span<const Value> radiosity() const = 0;

  /// What its error can be told from.
  [[nodiscard]] virtual std::span<const Value> change() const = 0;
  [[nodiscard]] virtual ChangeKind change_kind() const = 0;

  /// False where change() comes from a recurrence, which drifts from the truth: the truth must be looked at
  /// before it is relied on, and the method started again from there where it was wrong.
  [[nodiscard]] virtual bool change_is_exact() const { return true; }
  virtual void restart(std::span<const Value> /*B*/, std::span<const Value> /*residual*/) {}

  /// Leaves a channel as it is from now on, until restart: it is good enough.
  virtual void hold(int /*channel*/) {}

  /// The method cannot go on: the system is not positive definite.
  [[nodiscard]] virtual bool broken_down() const { return false; }
};

/// B = E + rho F B, applied again and again.
template <class Value>
[[nodiscard]] std::unique_ptr<Iteration<Value>> make_jacobi(const LinearSystem<Value>& system,
                                                            std::span<const Value> start);

/// The same with F.sweep: each row uses the newest values.
template <class Value>
[[nodiscard]] std::unique_ptr<Iteration<Value>> make_gauss_seidel(const LinearSystem<Value>& system,
                                                                  std::span<const Value> start);

/// Southwell's relaxation (1946) by blocks, which is progressive refinement (Cohen, Chen, Wallace & Greenberg
/// 1988): an iteration shoots from the tiles that hold the largest half of the power not yet shot, so that
/// early iterations cost little and light up most. B includes what has not been shot.
template <class Value>
[[nodiscard]] std::unique_ptr<Iteration<Value>> make_southwell(const LinearSystem<Value>& system,
                                                               std::span<const Value> start);

/// Conjugate gradients (Hestenes & Stiefel 1952) on the symmetric form: with R = sqrt(rho / A), G = A F and
/// u = sqrt(rho A) H it is (I - R G R) u = R G E, positive definite where the spectral radius of rho F is
/// below 1. Each channel has its own coefficients and its own end. B = E + R u; the residual of B is R times
/// that of u.
template <class Value>
[[nodiscard]] std::unique_ptr<Iteration<Value>> make_conjugate_gradients(const LinearSystem<Value>& system,
                                                                         std::span<const Value> start);

}  // namespace fluxel

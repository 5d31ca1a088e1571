#pragma once

#include <span>

#include "core/rgb.hpp"

namespace fluxel {

/// The form-factor matrix F as solvers see it: rows of one rank, of all, or (later) something else that can
/// do the same. Vectors have an entry for each unknown side of the whole scene.
class RadiosityOperator {
 public:
  virtual ~RadiosityOperator() = default;

  /// H = F x; each colour by itself.
  virtual void apply(std::span<const Rgb> x, std::span<Rgb> H) = 0;
  /// The same of one channel alone, with the digits that each of three would have.
  virtual void apply(std::span<const double> x, std::span<double> H) = 0;

  /// One Gauss-Seidel sweep in place: x_i = E_i + rho_i (F x)_i in the order of the elements, each row with
  /// the newest values it can have.
  virtual void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) = 0;
  virtual void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) = 0;
};

}  // namespace fluxel

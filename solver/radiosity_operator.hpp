#pragma once

#include <span>

#include "core/ranks.hpp"
#include "core/rgb.hpp"

namespace fluxel {

/// The form-factor matrix F as solvers see it. Vectors have an entry for each unknown side of this rank's
/// part of the scene, which is all of it where there is no other rank; all ranks() call everything together.
class RadiosityOperator {
 public:
  virtual ~RadiosityOperator() = default;

  /// Those that share the vectors.
  [[nodiscard]] virtual const Ranks& ranks() const {
    static const Ranks alone;
    return alone;
  }

  /// Whether it does the same to all colours.
  [[nodiscard]] virtual bool is_grey() const { return true; }

  /// H = F x; each colour by itself.
  virtual void apply(std::span<const Rgb> x, std::span<Rgb> H) = 0;
  /// The same of one channel alone, with the digits that each of three would have; where colours differ, no
  /// less than of any of them.
  virtual void apply(std::span<const double> x, std::span<double> H) = 0;

  /// One Gauss-Seidel sweep in place: x_i = E_i + rho_i (F x)_i in the order of the elements, each row with
  /// the newest values it can have.
  virtual void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) = 0;
  virtual void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) = 0;
};

}  // namespace fluxel

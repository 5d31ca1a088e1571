#pragma once

#include <vector>

#include "solver/radiosity_operator.hpp"

namespace fluxel {

/// D F D with a positive diagonal D: with G symmetric, D G D is, so reciprocity is kept.
class ScaledOperator final : public RadiosityOperator {
 public:
  /// `F` must outlive this; `scale` has an entry an unknown.
  ScaledOperator(RadiosityOperator& F, std::vector<double> scale);

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;

  [[nodiscard]] const std::vector<double>& scale() const { return scale_; }

 private:
  RadiosityOperator& F_;
  std::vector<double> scale_;
  std::vector<Rgb> scaled_x_, scaled_E_, scaled_rho_;
};

}  // namespace fluxel

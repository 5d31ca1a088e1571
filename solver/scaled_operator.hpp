#pragma once

#include <vector>

#include "solver/radiosity_operator.hpp"

namespace fluxel {

/// D F D with a positive diagonal D: with G symmetric, D G D is, so reciprocity is kept.
class ScaledOperator final : public RadiosityOperator {
 public:
  /// `F` must outlive this; `scale` has an entry an unknown.
  ScaledOperator(RadiosityOperator& F, std::vector<double> scale);

  [[nodiscard]] const Ranks& ranks() const override { return F_.ranks(); }

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  [[nodiscard]] const std::vector<double>& scale() const { return scale_; }

 private:
  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H);
  template <class Value>
  void sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x);

  RadiosityOperator& F_;
  std::vector<double> scale_;
};

}  // namespace fluxel

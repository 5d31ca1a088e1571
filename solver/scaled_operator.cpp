#include "solver/scaled_operator.hpp"

#include <utility>

namespace fluxel {

ScaledOperator::ScaledOperator(RadiosityOperator& F, std::vector<double> scale)
    : F_(F), scale_(std::move(scale)) {}

void ScaledOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) { apply_to(x, H); }
void ScaledOperator::apply(std::span<const double> x, std::span<double> H) { apply_to(x, H); }

void ScaledOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  sweep_over(E, rho, x);
}
void ScaledOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  sweep_over(E, rho, x);
}

template <class Value>
void ScaledOperator::apply_to(std::span<const Value> x, std::span<Value> H) {
  std::vector<Value> scaled_x(scale_.size());
  for (std::size_t i = 0; i < scale_.size(); ++i) scaled_x[i] = scale_[i] * x[i];
  F_.apply(scaled_x, H);
  for (std::size_t i = 0; i < scale_.size(); ++i) H[i] *= scale_[i];
}

template <class Value>
void ScaledOperator::sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) {
  // x = E + rho D F D x is z = D E + (D rho D) F z with z = D x.
  std::vector<Value> scaled_x(scale_.size()), scaled_E(scale_.size()), scaled_rho(scale_.size());
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    scaled_x[i] = scale_[i] * x[i];
    scaled_E[i] = scale_[i] * E[i];
    scaled_rho[i] = scale_[i] * scale_[i] * rho[i];
  }
  F_.sweep(scaled_E, scaled_rho, scaled_x);
  for (std::size_t i = 0; i < scale_.size(); ++i) x[i] = scaled_x[i] / scale_[i];
}

}  // namespace fluxel

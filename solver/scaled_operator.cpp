#include "solver/scaled_operator.hpp"

#include <utility>

namespace fluxel {

ScaledOperator::ScaledOperator(RadiosityOperator& F, std::vector<double> scale)
    : F_(F), scale_(std::move(scale)), scaled_x_(scale_.size()) {}

void ScaledOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) {
  for (std::size_t i = 0; i < scale_.size(); ++i) scaled_x_[i] = scale_[i] * x[i];
  F_.apply(scaled_x_, H);
  for (std::size_t i = 0; i < scale_.size(); ++i) H[i] *= scale_[i];
}

void ScaledOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  // x = E + rho D F D x is z = D E + (D rho D) F z with z = D x.
  scaled_E_.resize(scale_.size());
  scaled_rho_.resize(scale_.size());
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    scaled_x_[i] = scale_[i] * x[i];
    scaled_E_[i] = scale_[i] * E[i];
    scaled_rho_[i] = scale_[i] * scale_[i] * rho[i];
  }
  F_.sweep(scaled_E_, scaled_rho_, scaled_x_);
  for (std::size_t i = 0; i < scale_.size(); ++i) x[i] = scaled_x_[i] / scale_[i];
}

}  // namespace fluxel

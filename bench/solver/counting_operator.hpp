#pragma once

#include "solver/radiosity_operator.hpp"

namespace fluxel::bench {

/// Counts the products with F.
class CountingOperator final : public RadiosityOperator {
 public:
  explicit CountingOperator(RadiosityOperator& F) : F_(F) {}

  [[nodiscard]] int applications() const { return applications_; }

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override { count().apply(x, H); }
  void apply(std::span<const double> x, std::span<double> H) override { count().apply(x, H); }
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override {
    count().sweep(E, rho, x);
  }
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override {
    count().sweep(E, rho, x);
  }

 private:
  RadiosityOperator& count() {
    ++applications_;
    return F_;
  }

  RadiosityOperator& F_;
  int applications_ = 0;
};

}  // namespace fluxel::bench

#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fluxel::bench {

/// y = factor * x^power.
struct PowerLaw {
  double factor = 0;
  double power = 0;
};

/// Least squares in log-log over points (x, y) above 0; nothing where fewer than two differ in x.
[[nodiscard]] std::optional<PowerLaw> fit_power_law(const std::vector<std::pair<double, double>>& points);

/// As "3.2e-09 N^2.03", or "no fit".
[[nodiscard]] std::string describe(const std::optional<PowerLaw>& law, const std::string& variable);

}  // namespace fluxel::bench

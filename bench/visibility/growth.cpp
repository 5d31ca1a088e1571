#include "bench/visibility/growth.hpp"

#include <fmt/format.h>

#include <cmath>

namespace fluxel::bench {

std::optional<PowerLaw> fit_power_law(const std::vector<std::pair<double, double>>& points) {
  double mean_x = 0, mean_y = 0, square = 0, product = 0;
  const auto count = static_cast<double>(points.size());
  for (const auto& [x, y] : points) {
    mean_x += std::log(x) / count;
    mean_y += std::log(y) / count;
  }
  for (const auto& [x, y] : points) {
    square += (std::log(x) - mean_x) * (std::log(x) - mean_x);
    product += (std::log(x) - mean_x) * (std::log(y) - mean_y);
  }
  if (!(square > 1e-12)) return std::nullopt;
  const double power = product / square;
  return PowerLaw{std::exp(mean_y - power * mean_x), power};
}

std::string describe(const std::optional<PowerLaw>& law, const std::string& variable) {
  if (!law) return "no fit";
  return fmt::format("{:.2g} {}^{:.2f}", law->factor, variable, law->power);
}

}  // namespace fluxel::bench

#include "output/receiver_figures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image/tone_map.hpp"

namespace fluxel {

namespace {

/// Of two whose errors are independent.
std::optional<Stated> quotient(const Stated& a, const Stated& b) {
  if (!(b.value > 0)) return std::nullopt;
  return Stated{a.value / b.value, std::hypot(a.error, a.value / b.value * b.error) / b.value};
}

Json stated_json(const Stated& stated) {
  return {{"value", number(stated.value)}, {"error", number(stated.error)}};
}

Stated with_solution_error(const Stated& noisy, double relative) {
  return {noisy.value, std::hypot(noisy.error, relative * noisy.value)};
}

}  // namespace

ReceiverFigures receiver_figures(const SensorLight& light, double relative) {
  std::vector<Stated> cells;
  Stated mean;
  for (const SensorEstimate& of : light.measured.sensors) {
    const Stated& cell = cells.emplace_back(Stated{luminance(of.mean), luminance(of.error)});
    mean.value += cell.value;
    mean.error += cell.error * cell.error;
  }
  const auto count = static_cast<double>(cells.size());
  mean = {mean.value / count, std::sqrt(mean.error) / count};
  const auto [min, max] = std::ranges::minmax(cells, {}, &Stated::value);
  ReceiverFigures figures{with_solution_error(mean, relative),
                          with_solution_error(min, relative),
                          with_solution_error(max, relative),
                          {},
                          {}};
  // The solution may be off by so much in one place, and less in the mean.
  figures.U0 = quotient(figures.min, mean);
  figures.Ud = quotient(figures.min, with_solution_error(max, relative));
  return figures;
}

Json figures_json(const ReceiverFigures& figures) {
  const auto if_known = [](const std::optional<Stated>& stated) {
    return stated ? stated_json(*stated) : Json(nullptr);
  };
  return {{"mean", stated_json(figures.mean)},
          {"min", stated_json(figures.min)},
          {"max", stated_json(figures.max)},
          {"U0", if_known(figures.U0)},
          {"Ud", if_known(figures.Ud)}};
}

}  // namespace fluxel

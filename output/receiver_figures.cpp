#include "output/receiver_figures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/luminance.hpp"

namespace fluxel {

namespace {

/// Of two whose errors are independent.
std::optional<Stated> quotient(const Stated& a, const Stated& b) {
  if (!(b.value > 0)) return std::nullopt;
  return Stated{a.value / b.value, std::hypot(a.error, a.value / b.value * b.error) / b.value};
}

}  // namespace

Json stated_json(const Stated& stated) {
  return {{"value", number(stated.value)}, {"error", number(stated.error)}};
}

namespace {

Stated with_solution_error(const Stated& noisy, double relative) {
  return {noisy.value, std::hypot(noisy.error, relative * noisy.value)};
}

/// Of a cell's relative error.
std::size_t bin_of(double error) {
  return static_cast<std::size_t>(std::ranges::upper_bound(kErrorBins, error) - kErrorBins.begin());
}

}  // namespace

ReceiverFigures receiver_figures(const Receiver& receiver, const SensorLight& light, double relative) {
  std::vector<Stated> cells;
  Stated mean;
  ReceiverFigures figures;
  for (std::size_t k = 0; k < light.measured.sensors.size(); ++k) {
    if (!receiver.measures(k)) continue;
    const SensorEstimate& of = light.measured.sensors[k];
    const Stated& cell = cells.emplace_back(Stated{luminance(of.mean), luminance(of.error)});
    mean.value += cell.value;
    mean.error += cell.error * cell.error;
    const Stated stated = with_solution_error(cell, relative);
    ++figures.errors[stated.value > 0 ? bin_of(stated.error / stated.value) : kErrorBins.size()];
  }
  const auto count = static_cast<double>(cells.size());
  mean = {mean.value / count, std::sqrt(mean.error) / count};
  const auto [min, max] = std::ranges::minmax(cells, {}, &Stated::value);
  figures.mean = with_solution_error(mean, relative);
  figures.min = with_solution_error(min, relative);
  figures.max = with_solution_error(max, relative);
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
          {"Ud", if_known(figures.Ud)},
          {"error_histogram", {{"below", kErrorBins}, {"cells", figures.errors}}}};
}

}  // namespace fluxel

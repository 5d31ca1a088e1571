#include "output/receiver_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
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

std::string stated_text(const Stated& stated) {
  return std::isfinite(stated.error) ? fmt::format("{:.4g} +- {:.2g}", stated.value, stated.error)
                                     : fmt::format("{:.4g}, error not known,", stated.value);
}

Json stated_json(const Stated& stated) {
  return {{"value", number(stated.value)}, {"error", number(stated.error)}};
}

namespace {

/// A cell, and by two halves of its rays that err independently.
struct Cell {
  Stated stated;
  double half_a = 0, half_b = 0;
};

/// The value that comes first. That of many noisy cells is further out than the true one on average; what a
/// cell that is the first by one half of its rays has by the other half is less far out. Stated is the middle
/// between the two, with half their distance in the error.
template <class Before>
Stated extreme(const std::vector<Cell>& cells, Before before) {
  const auto first = [&](auto member) { return *std::ranges::min_element(cells, before, member); };
  const Stated noisy = first([](const Cell& cell) { return cell.stated.value; }).stated;
  const double crossed = 0.5 * (first(&Cell::half_a).half_b + first(&Cell::half_b).half_a);
  // Not where noise of the halves has it further out.
  const double gap = before(noisy.value, crossed) ? std::abs(crossed - noisy.value) : 0;
  return {before(noisy.value, crossed) ? 0.5 * (noisy.value + crossed) : noisy.value,
          std::hypot(noisy.error, 0.5 * gap)};
}

/// Of a cell's relative error.
std::size_t bin_of(double error) {
  return static_cast<std::size_t>(std::ranges::upper_bound(kErrorBins, error) - kErrorBins.begin());
}

}  // namespace

ReceiverFigures receiver_figures(const Receiver& receiver, const SensorLight& light) {
  std::vector<Cell> cells;
  Stated mean;
  ReceiverFigures figures;
  for (std::size_t k = 0; k < light.measured.sensors.size(); ++k) {
    if (!receiver.measures(k)) continue;
    const SensorEstimate& of = light.measured.sensors[k];
    const Cell& cell = cells.emplace_back(
        Cell{{luminance(of.mean), luminance(of.error)}, luminance(of.half_a), luminance(of.half_b)});
    mean.value += cell.stated.value;
    mean.error += cell.stated.error * cell.stated.error;
    const Stated& stated = cell.stated;
    ++figures.errors[stated.value > 0 ? bin_of(stated.error / stated.value) : kErrorBins.size()];
  }
  const auto count = static_cast<double>(cells.size());
  figures.mean = {mean.value / count, std::sqrt(mean.error) / count};
  figures.min = extreme(cells, std::less<>());
  figures.max = extreme(cells, std::greater<>());
  figures.U0 = quotient(figures.min, figures.mean);
  figures.Ud = quotient(figures.min, figures.max);
  return figures;
}

Json figures_json(const ReceiverFigures& figures) {
  const auto if_known = [](const std::optional<Stated>& stated) {
    return stated ? stated_json(*stated) : Json(nullptr);
  };
  return {{"mean", stated_json(figures.mean)},
          {"min", stated_json(figures.min)},
          {"max", stated_json(figures.max)},
          {"u0", if_known(figures.U0)},
          {"ud", if_known(figures.Ud)},
          {"error_histogram", {{"below", kErrorBins}, {"cells", figures.errors}}}};
}

}  // namespace fluxel

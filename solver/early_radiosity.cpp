#include "solver/early_radiosity.hpp"

#include "solver/iteration.hpp"

namespace fluxel {

namespace {

/// Area times magnitude, summed over all unknowns: heat that is drawn is no less to do than heat that is
/// sent.
Rgb over_area(const LinearSystem<Rgb>& system, std::span<const Rgb> values) {
  return sum_over<Rgb>(system.F.ranks(), values.size(),
                       [&](std::size_t i) { return system.area[i] * glm::abs(values[i]); });
}

}  // namespace

void shoot_early_radiosity(RadiosityOperator& F, const Unknowns& unknowns, const ShotObserver& observer) {
  const LinearSystem<Rgb> system = make_system<Rgb>(F, unknowns);
  const auto southwell = make_southwell(system, std::span<const Rgb>(system.E));
  const Rgb emitted = over_area(system, system.E);
  const Rgb absorbed = Rgb(system.total_area) - over_area(system, system.rho);
  std::vector<Rgb> B(system.size());
  double left = 1;
  do {
    southwell->advance();
    const Rgb unshot = over_area(system, southwell->change());
    left = (unshot.r + unshot.g + unshot.b) / (emitted.r + emitted.g + emitted.b);
    // What all reflections of evenly spread light make of it: a geometric series [W/m2].
    const Rgb around = by_channel([](double p, double a) { return a > 0 ? p / a : 0; }, unshot, absorbed);
    for (std::size_t i = 0; i < B.size(); ++i) B[i] = southwell->radiosity()[i] + unknowns.rho[i] * around;
  } while (observer(B, left));
}

}  // namespace fluxel

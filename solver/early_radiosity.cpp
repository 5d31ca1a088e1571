#include "solver/early_radiosity.hpp"

#include "solver/iteration.hpp"

namespace fluxel {

namespace {

/// Sum over all unknowns of area times magnitude: heat that is drawn is no less to do than heat that is sent.
Rgb over_area(const Unknowns& unknowns, std::span<const Rgb> values) {
  Rgb sum(0);
  for (std::size_t i = 0; i < values.size(); ++i) sum += unknowns.area[i] * glm::abs(values[i]);
  return sum;
}

/// What all reflections of evenly spread light of this power make of it: a geometric series [W/m2].
Rgb ambient(const Unknowns& unknowns, const Rgb& power) {
  double area = 0;
  for (const double A : unknowns.area) area += A;
  const Rgb absorbed = Rgb(area) - over_area(unknowns, unknowns.rho);
  return by_channel([](double p, double a) { return a > 0 ? p / a : 0; }, power, absorbed);
}

}  // namespace

void shoot_early_radiosity(RadiosityOperator& F, const Unknowns& unknowns, const ShotObserver& observer) {
  const LinearSystem<Rgb> system = make_system<Rgb>(F, unknowns);
  const auto southwell = make_southwell(system, std::span<const Rgb>(system.E));
  const Rgb emitted = over_area(unknowns, unknowns.E);
  std::vector<Rgb> B(system.size());
  double left = 1;
  do {
    southwell->advance();
    const Rgb unshot = over_area(unknowns, southwell->change());
    left = (unshot.r + unshot.g + unshot.b) / (emitted.r + emitted.g + emitted.b);
    const Rgb around = ambient(unknowns, unshot);
    for (std::size_t i = 0; i < B.size(); ++i) B[i] = southwell->radiosity()[i] + unknowns.rho[i] * around;
  } while (observer(B, left));
}

}  // namespace fluxel

#include "optics/luminaire_emission.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {

LuminaireEmission::LuminaireEmission(const Luminaire& luminaire, const IntensityTable& table)
    : luminaire_(luminaire), table_(table), across_(glm::cross(luminaire.ahead, luminaire.aim)) {
  const std::size_t planes = std::max<std::size_t>(1, table.C.size() - 1);
  double sum = 0;
  for (std::size_t c = 0; c < planes; ++c)
    for (std::size_t g = 0; g + 1 < table.gamma.size(); ++g) {
      const double most =
          std::max({table.at(c, g), table.at(c, g + 1), table.at(next(c), g), table.at(next(c), g + 1)});
      ends_.push_back(sum += most * solid_angle(c, g));
    }
}

double LuminaireEmission::width(std::size_t c) const {
  return table_.C.size() > 1 ? table_.C[c + 1] - table_.C[c] : 2 * std::numbers::pi;
}

double LuminaireEmission::solid_angle(std::size_t c, std::size_t g) const {
  return width(c) * (std::cos(table_.gamma[g]) - std::cos(table_.gamma[g + 1]));
}

EmittedRay LuminaireEmission::ray(const std::array<double, 4>& numbers, double lift) const {
  const double at = numbers[0] * ends_.back();
  const auto found = std::ranges::upper_bound(ends_, at);
  const auto cell = static_cast<std::size_t>(std::min(found, ends_.end() - 1) - ends_.begin());
  const std::size_t rows = table_.gamma.size() - 1, c = cell / rows, g = cell % rows;
  const double before = cell > 0 ? ends_[cell - 1] : 0, most = ends_[cell] - before;
  const double top = std::cos(table_.gamma[g]), bottom = std::cos(table_.gamma[g + 1]);
  // What the choice of the cell leaves of its number is uniform again.
  const double C = from(c) + std::min((at - before) / most, 1.0) * width(c);
  const double cosine = std::clamp(top + numbers[1] * (bottom - top), -1.0, 1.0);
  const double gamma = std::acos(cosine), sine = std::sin(gamma);
  EmittedRay ray;
  ray.direction =
      sine * std::cos(C) * luminaire_.ahead + sine * std::sin(C) * across_ + cosine * luminaire_.aim;
  ray.from = opening_point(luminaire_, numbers[2], numbers[3]) + (cosine > 0 ? lift : -lift) * luminaire_.aim;
  ray.weight = intensity(table_, C, gamma) * solid_angle(c, g) * ends_.back() / most;
  return ray;
}

}  // namespace fluxel

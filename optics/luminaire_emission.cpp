#include "optics/luminaire_emission.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <tuple>

namespace fluxel {

LuminaireEmission::LuminaireEmission(const Luminaire& luminaire, const IntensityTable& table)
    : luminaire_(luminaire), table_(table), across_(glm::cross(luminaire.ahead, luminaire.aim)) {
  const std::size_t planes = std::max<std::size_t>(1, table.C.size() - 1);
  double sum = 0;
  for (std::size_t c = 0; c < planes; ++c)
    for (std::size_t g = 0; g + 1 < table.gamma.size(); ++g) {
      const IntensityCell cell(table, c, g);
      if (!(cell.flux() > 0)) continue;
      cells_.push_back(cell);
      ends_.push_back(sum += cell.flux());
    }
}

bool LuminaireEmission::is_same(const LuminaireEmission& other) const {
  const Luminaire &a = luminaire_, &b = other.luminaire_;
  return std::tie(a.position, a.aim, a.ahead, a.size, a.round) ==
             std::tie(b.position, b.aim, b.ahead, b.size, b.round) &&
         std::tie(table_.C, table_.gamma, table_.intensity) ==
             std::tie(other.table_.C, other.table_.gamma, other.table_.intensity);
}

EmittedRay LuminaireEmission::ray(const std::array<double, 4>& numbers, double lift) const {
  const double at = numbers[0] * ends_.back();
  const auto found = std::ranges::upper_bound(ends_, at);
  const auto cell = static_cast<std::size_t>(std::min(found, ends_.end() - 1) - ends_.begin());
  const double before = cell > 0 ? ends_[cell - 1] : 0;
  // What the choice of the cell leaves of its number is uniform again (Dmitriev 2002, equation 12).
  const double rest = std::clamp((at - before) / (ends_[cell] - before), 0.0, 1.0);
  const auto [C, gamma] = cells_[cell].direction(rest, numbers[1]);
  const double sine = std::sin(gamma), cosine = std::cos(gamma);
  EmittedRay ray;
  ray.direction =
      sine * std::cos(C) * luminaire_.ahead + sine * std::sin(C) * across_ + cosine * luminaire_.aim;
  ray.from = opening_point(luminaire_, numbers[2], numbers[3]) + (cosine > 0 ? lift : -lift) * luminaire_.aim;
  return ray;
}

}  // namespace fluxel

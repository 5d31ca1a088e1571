#include "solver/refinement_error.hpp"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>

#include "solver/channels.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

namespace {

/// Area-mean of the product of two vectors, relative to `unit` squared, for each colour.
Rgb mean_product(std::span<const double> area, std::span<const Rgb> x, std::span<const Rgb> y,
                 const Rgb& unit) {
  Rgb sum(0);
  double whole = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += area[i] * (x[i] / unit) * (y[i] / unit);
    whole += area[i];
  }
  return whole > 0 ? sum / whole : Rgb(0);
}

double sum_of(const Rgb& colours) { return colours.r + colours.g + colours.b; }

/// `fine`, averaged over the coarser elements, less their B.
MeshRadiosity difference(const MeshRadiosity& fine, const CoarserRadiosity& coarse) {
  MeshRadiosity result = averaged(fine, coarse.first);
  for (std::size_t i = 0; i < result.B.size(); ++i) result.B[i] -= coarse.radiosity.B[i];
  return result;
}

/// A divisor for each colour, where nothing has the colour too.
Rgb unit_of(const MeshRadiosity& radiosity) {
  const Rgb mean = area_mean(radiosity.area, radiosity.B);
  return by_channel([](double x, double) { return x > 0 ? x : 1.0; }, mean, mean);
}

}  // namespace

MeshRadiosity averaged(const MeshRadiosity& fine, std::span<const std::uint32_t> first) {
  const std::size_t coarse_elements = first.size() - 1, fine_elements = first.back();
  const std::size_t sides = fine.B.size() / fine_elements;
  MeshRadiosity result{std::vector<double>(sides * coarse_elements),
                       std::vector<Rgb>(sides * coarse_elements)};
  for (std::size_t side = 0; side < sides; ++side)
    for (std::size_t i = 0; i < coarse_elements; ++i) {
      double area = 0;
      Rgb power(0);
      for (std::size_t k = side * fine_elements + first[i]; k < side * fine_elements + first[i + 1]; ++k) {
        area += fine.area[k];
        power += fine.area[k] * fine.B[k];
      }
      result.area[side * coarse_elements + i] = area;
      result.B[side * coarse_elements + i] = area > 0 ? power / area : Rgb(0);
    }
  return result;
}

RefinementError refinement_error(const MeshRadiosity& fine, std::span<const CoarserRadiosity> coarser,
                                 const Rgb& iteration) {
  const Rgb unit = unit_of(fine);
  const MeshRadiosity D1 = difference(fine, coarser[0]);
  const Rgb squares = mean_product(D1.area, D1.B, D1.B, unit);
  const double of_D1 = sum_of(squares);
  const Rgb most_of_D1 = glm::sqrt(squares) + iteration;
  RefinementError result;
  double g = std::exp2(kUnseenOrder), c = 1;
  if (coarser.size() > 1 && of_D1 > 0) {
    const MeshRadiosity D2 = difference(coarser[0].radiosity, coarser[1]);
    const MeshRadiosity RD1 = averaged(D1, coarser[1].first);
    const double of_D2 = sum_of(mean_product(D2.area, D2.B, D2.B, unit));
    const double of_RD1 = sum_of(mean_product(D2.area, RD1.B, RD1.B, unit));
    const double of_both = sum_of(mean_product(D2.area, RD1.B, D2.B, unit));
    result.order = 0.5 * std::log2(of_D2 / sum_of(most_of_D1 * most_of_D1));
    result.survival = std::sqrt(of_RD1 / of_D1);
    result.alignment = of_both > 0 ? of_both / std::sqrt(of_RD1 * of_D2) : 0;
    g = std::exp2(std::clamp(*result.order, kLowestOrder, kHighestOrder));
    c = result.alignment;
  }
  const double q = result.survival / g;
  const double factor = std::sqrt((1 + c * q) / ((1 - c * q) * (1 - q * q))) / g;
  result.error = factor * most_of_D1;
  return result;
}

}  // namespace fluxel

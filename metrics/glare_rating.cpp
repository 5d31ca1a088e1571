#include "metrics/glare_rating.hpp"

#include <cmath>
#include <numbers>

namespace fluxel {

double position_index(double from_sight, double from_upright) {
  constexpr double kDegree = std::numbers::pi / 180;
  const double sigma = from_sight / kDegree, tau = from_upright / kDegree;
  return std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                  (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
}

std::optional<GlareRating> glare_rating(const GlareSources& sources, double background, double error) {
  if (!(sources.weighted > 0) || !(background > error)) return std::nullopt;
  return GlareRating{8 * std::log10(0.25 / background * sources.weighted),
                     std::hypot(8 / std::numbers::ln10 * error / background, kErrorOfPositions)};
}

}  // namespace fluxel

#include "optics/luminaire_escape.hpp"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "formfactor/even_points.hpp"
#include "scene/scene.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

namespace {

/// Rays of one luminaire, and of all together where there are many.
constexpr std::size_t kRaysOfOne = 4096, kRaysOfAll = std::size_t{1} << 18, kLeastRays = 64;

/// Directions of a table, drawn by its intensity: first a cell between its angles, then a direction evenly
/// over the cell's solid angle, with the weight that makes up for what the intensity varies by over it.
class DirectionDraw {
 public:
  explicit DirectionDraw(const IntensityTable& table) : table_(table) {
    const std::size_t planes = std::max<std::size_t>(1, table.C.size() - 1);
    double sum = 0;
    for (std::size_t c = 0; c < planes; ++c)
      for (std::size_t g = 0; g + 1 < table.gamma.size(); ++g) {
        const double most =
            std::max({table.at(c, g), table.at(c, g + 1), table.at(next(c), g), table.at(next(c), g + 1)});
        ends_.push_back(sum += most * solid_angle(c, g));
      }
  }

  struct Direction {
    double C, gamma, weight;  ///< the weight is of the table's flux
  };
  [[nodiscard]] Direction direction(double choice, double u, double v) const {
    const auto found = std::ranges::upper_bound(ends_, choice * ends_.back());
    const auto cell = static_cast<std::size_t>(std::min(found, ends_.end() - 1) - ends_.begin());
    const std::size_t rows = table_.gamma.size() - 1, c = cell / rows, g = cell % rows;
    const double share = (ends_[cell] - (cell > 0 ? ends_[cell - 1] : 0)) / ends_.back();
    const double top = std::cos(table_.gamma[g]), bottom = std::cos(table_.gamma[g + 1]);
    const double C = from(c) + u * width(c);
    const double gamma = std::acos(std::clamp(top + v * (bottom - top), -1.0, 1.0));
    return {C, gamma, intensity(table_, C, gamma) * solid_angle(c, g) / share};
  }

 private:
  [[nodiscard]] std::size_t next(std::size_t c) const { return table_.C.size() > 1 ? c + 1 : c; }
  [[nodiscard]] double from(std::size_t c) const { return table_.C.size() > 1 ? table_.C[c] : 0; }
  [[nodiscard]] double width(std::size_t c) const {
    return table_.C.size() > 1 ? table_.C[c + 1] - table_.C[c] : 2 * std::numbers::pi;
  }
  [[nodiscard]] double solid_angle(std::size_t c, std::size_t g) const {
    return width(c) * (std::cos(table_.gamma[g]) - std::cos(table_.gamma[g + 1]));
  }

  const IntensityTable& table_;
  std::vector<double> ends_;
};

}  // namespace

LuminaireEscape luminaire_escape(const RayScene& ray_scene) {
  const Scene& scene = ray_scene.scene();
  const FirstSide first_side(ray_scene);
  LuminaireEscape escape;
  Rgb variance(0);
  const std::size_t rays =
      std::clamp(kRaysOfAll / std::max<std::size_t>(1, scene.luminaires.size()), kLeastRays, kRaysOfOne);
  for (std::size_t number = 0; number < scene.luminaires.size(); ++number) {
    const Luminaire& of = scene.luminaires[number];
    const IntensityTable& table = scene.intensity(of);
    const double whole = flux(table);
    escape.flux += whole * of.scale;
    if (!(whole > 0)) continue;
    const DirectionDraw draw(table);
    const glm::dvec3 across = glm::cross(of.ahead, of.aim);
    SobolPoints points(number);
    SobolPoints places(~number);
    double escaped = 0, dark = 0, squares = 0;
    for (std::size_t k = 0; k < rays; ++k) {
      const auto [u, v, choice, unused] = points.next();
      const auto to = draw.direction(choice, u, v);
      const double sine = std::sin(to.gamma);
      const glm::dvec3 direction =
          sine * std::cos(to.C) * of.ahead + sine * std::sin(to.C) * across + std::cos(to.gamma) * of.aim;
      const auto [s, t, third, fourth] = places.next();
      const glm::dvec3 from = opening_point(of, s, t) + (to.gamma < 0.5 * std::numbers::pi ? 1.0 : -1.0) *
                                                            static_cast<double>(ray_scene.surface_epsilon()) *
                                                            of.aim;
      const MetSide met = first_side.meet(from, direction);
      if (met.patch == kNoPatch)
        escaped += to.weight;
      else if (!met.active)
        dark += to.weight;
      else
        continue;
      squares += to.weight * to.weight;
    }
    const auto count = static_cast<double>(rays);
    escape.escaped += escaped / count * of.scale;
    escape.dark += dark / count * of.scale;
    const double mean = (escaped + dark) / count;
    variance += std::max(0.0, squares / count - mean * mean) / count * (of.scale * of.scale);
  }
  escape.error = glm::sqrt(variance);
  return escape;
}

}  // namespace fluxel

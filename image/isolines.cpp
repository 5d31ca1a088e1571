#include "image/isolines.hpp"

#include <cmath>

namespace fluxel {

namespace {

struct GridPoint {
  glm::dvec2 at{0};
  double value = 0;
};

/// Where a side of a square, whose ends are on different sides of the level, meets it.
glm::dvec2 crossing(const GridPoint& a, const GridPoint& b, double level) {
  return a.at + (level - a.value) / (b.value - a.value) * (b.at - a.at);
}

}  // namespace

std::vector<std::array<glm::dvec2, 2>> isolines(std::span<const double> values, int columns, double level) {
  std::vector<std::array<glm::dvec2, 2>> lines;
  const int rows = static_cast<int>(values.size()) / columns;
  const auto point = [&](int column, int row) {
    return GridPoint{{column + 0.5, row + 0.5},
                     values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                            static_cast<std::size_t>(column)]};
  };
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      // Around the square, so that crossed sides come in an order that can be paired.
      const std::array<GridPoint, 4> corner{point(column, row), point(column + 1, row),
                                            point(column + 1, row + 1), point(column, row + 1)};
      std::array<glm::dvec2, 4> met{};
      std::size_t count = 0;
      double sum = 0;
      for (std::size_t k = 0; k < corner.size(); ++k) {
        const GridPoint &a = corner[k], &b = corner[(k + 1) % corner.size()];
        sum += a.value;
        if ((a.value >= level) != (b.value >= level)) met[count++] = crossing(a, b, level);
      }
      if (!std::isfinite(sum) || count < 2) continue;
      // Of a saddle: the first corner is cut off where the middle is on the other side of the level.
      const bool cut_off = count == 4 && (corner[0].value >= level) != (sum / 4 >= level);
      if (cut_off) {
        lines.push_back({met[3], met[0]});
        lines.push_back({met[1], met[2]});
      } else {
        lines.push_back({met[0], met[1]});
        if (count == 4) lines.push_back({met[2], met[3]});
      }
    }
  return lines;
}

}  // namespace fluxel

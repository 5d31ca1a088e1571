#include "scene/readers/c_planes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fluxel {
namespace {

/// Of 180 degrees pi to the last digit.
double in_radians(double degrees) { return degrees / 180 * std::numbers::pi; }

/// The plane C = 0 between the last plane and the first.
CPlane plane_at_0(const CPlane& last, const CPlane& first) {
  CPlane between{0, first.intensity};
  const double fraction = (360 - last.C) / (360 - last.C + first.C);
  for (std::size_t g = 0; g < between.intensity.size(); ++g)
    between.intensity[g] = std::lerp(last.intensity[g], first.intensity[g], fraction);
  return between;
}

}  // namespace

void mirror_planes(std::vector<CPlane>& planes) {
  const std::size_t count = planes.size();
  const double mirror = planes.back().C;
  planes.reserve(2 * count - 1);
  for (std::size_t c = count - 1; c-- > 0;) planes.push_back({2 * mirror - planes[c].C, planes[c].intensity});
}

IntensityTable make_intensity_table(std::vector<CPlane> planes, const std::vector<double>& gamma) {
  if (planes.size() == 1) {
    planes.front().C = 0;
  } else {
    for (CPlane& plane : planes) plane.C -= 360 * std::floor(plane.C / 360);
    std::ranges::stable_sort(planes, {}, &CPlane::C);
    const auto same = [](const CPlane& a, const CPlane& b) { return a.C == b.C; };  // 0 and 360 degrees
    planes.erase(std::unique(planes.begin(), planes.end(), same), planes.end());
    if (planes.front().C > 0) planes.insert(planes.begin(), plane_at_0(planes.back(), planes.front()));
    planes.push_back({360, planes.front().intensity});
  }
  IntensityTable table;
  for (const double angle : gamma) table.gamma.push_back(in_radians(angle));
  for (const CPlane& plane : planes) {
    table.C.push_back(in_radians(plane.C));
    table.intensity.insert(table.intensity.end(), plane.intensity.begin(), plane.intensity.end());
  }
  return table;
}

void note_dark_angles(const std::vector<double>& gamma, std::vector<std::string>& notes) {
  const double first = gamma.front(), last = gamma.back();
  if ((first == 0 || first == 90) && (last == 90 || last == 180)) return;
  notes.push_back(fmt::format(
      "vertical angles go from {} to {} degrees, not from 0 or 90 to 90 or 180: no light goes beyond them",
      first, last));
}

}  // namespace fluxel

#include "formfactor/even_points.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/sampling.hpp"

namespace fluxel {

namespace {

using SobolTable = std::array<std::array<std::uint32_t, SobolPoints::kAxes>, SobolPoints::kLength>;

const SobolTable& sobol_table() {
  static const SobolTable kTable = [] {
    SobolTable table;
    // The engine leaves out the origin, which belongs to the first power of two of points.
    table[0] = {};
    boost::random::sobol engine(SobolPoints::kAxes);
    for (std::size_t k = 1; k < table.size(); ++k)
      for (std::uint32_t& digits : table[k]) digits = static_cast<std::uint32_t>(engine() >> 32);
    return table;
  }();
  return kTable;
}

}  // namespace

SobolPoints::SobolPoints(std::uint64_t seed) {
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    shift_[axis] = static_cast<std::uint32_t>(random_bits(seed + axis * 0xD1342543DE82EF95ull) >> 32);
}

std::array<double, SobolPoints::kAxes> SobolPoints::next() {
  const auto& digits = sobol_table()[place_];
  place_ = (place_ + 1) % kLength;
  std::array<double, kAxes> point;
  // In the middle of the finest cell, so that no point lies on an edge.
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    point[axis] = (static_cast<double>(digits[axis] ^ shift_[axis]) + 0.5) * 0x1p-32;
  return point;
}

PolygonFan::PolygonFan(const SmallPolygon& corners) : corners_(corners) {
  double sum = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    sum += glm::length(glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]));
    ends_.push_back(sum);
  }
  // A polygon that rounding has flattened to a line has triangles without area, which share it alike.
  for (std::size_t k = 0; k < ends_.size(); ++k)
    ends_[k] = sum > 0 ? ends_[k] / sum : static_cast<double>(k + 1) / static_cast<double>(ends_.size());
}

glm::dvec3 PolygonFan::point(double u, double v) const {
  std::size_t k = 0;
  while (k + 1 < ends_.size() && u >= ends_[k]) ++k;
  const double start = k > 0 ? ends_[k - 1] : 0;
  const double root = std::sqrt(std::clamp((u - start) / (ends_[k] - start), 0.0, 1.0));
  return corners_[0] + root * (1 - v) * (corners_[k + 1] - corners_[0]) +
         root * v * (corners_[k + 2] - corners_[0]);
}

}  // namespace fluxel

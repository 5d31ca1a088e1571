#include "tests/ward_cache/ward_cache.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel::ward_cache {

namespace {

namespace bg = boost::geometry;

/// Of the radius: what a place may lie behind a record by rounding.
constexpr double kBehind = 1e-6;

/// The reciprocal of the weight: the error that is expected of it, relative: the split sphere of
/// Ward, Rubinstein & Clear 1988.
double expected_error(const WardRecord& record, const SidePoint& point) {
  const double cosine = glm::dot(record.at.normal, point.normal);
  return glm::distance(record.at.position, point.position) / record.radius +
         std::sqrt(std::max(0.0, 1 - cosine));
}

/// Whether the record sees what the place does not (there: d_i < 0).
bool lies_before(const WardRecord& record, const SidePoint& point) {
  const glm::dvec3 d = point.position - record.at.position;
  return glm::dot(d, 0.5 * (record.at.normal + point.normal)) < -kBehind * record.radius;
}

/// What it says of the place (Ward & Heckbert 1992: interpolation with both gradients).
Rgb extrapolated(const WardRecord& record, const SidePoint& point) {
  const glm::dvec3 turn = glm::cross(record.at.normal, point.normal);
  const glm::dvec3 d = point.position - record.at.position;
  Rgb H = record.irradiance;
  for (int c = 0; c < kChannels; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    H[c] += glm::dot(turn, record.rotation[channel]) + glm::dot(d, record.translation[channel]);
  }
  return H;
}

}  // namespace

/// No radius exceeds that of another record by more than the distance between both: what is near the one is
/// not far from the other (neighbour clamping: Krivanek et al. 2006). Both ways.
void WardCache::clamp_radii(WardRecord& added) {
  for (WardRecord& other : records_) {
    const double distance = glm::distance(other.at.position, added.at.position);
    added.radius = std::min(added.radius, other.radius + distance);
  }
  for (WardRecord& other : records_) {
    const double distance = glm::distance(other.at.position, added.at.position);
    other.radius = std::min(other.radius, added.radius + distance);
  }
}

void WardCache::add(const WardRecord& record) {
  WardRecord added = record;
  clamp_radii(added);
  const glm::dvec3 low = added.at.position - reach(added), high = added.at.position + reach(added);
  places_.insert({{Point(low.x, low.y, low.z), Point(high.x, high.y, high.z)},
                  static_cast<std::uint32_t>(records_.size())});
  records_.push_back(added);
}

std::optional<Rgb> WardCache::at(const SidePoint& point) const {
  const Point place(point.position.x, point.position.y, point.position.z);
  Rgb sum(0);
  double weights = 0;
  for (auto near = places_.qbegin(bg::index::intersects(place)); near != places_.qend(); ++near) {
    const WardRecord& record = records_[near->second];
    const double error = expected_error(record, point);
    if (error >= acceptance_ || lies_before(record, point)) continue;
    if (error == 0) return record.irradiance;
    sum += extrapolated(record, point) / error;
    weights += 1 / error;
  }
  if (weights == 0) return std::nullopt;
  return sum / weights;
}

}  // namespace fluxel::ward_cache

#include "scene/readers/round_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {
namespace {

constexpr int kSegments = 32, kBands = 16;
constexpr double kHalfSegment = std::numbers::pi / kSegments;  // the angle

/// The axis of what is round, and two directions across, right-handed.
struct Axis {
  explicit Axis(const glm::dvec3& any_length) : along(glm::normalize(any_length)) {
    const glm::dvec3 size = glm::abs(along);
    const glm::dvec3 other = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                             : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                  : glm::dvec3(0, 0, 1);
    u = glm::normalize(glm::cross(other, along));
    v = glm::cross(along, u);
  }

  [[nodiscard]] Corners circle(const glm::dvec3& centre, double radius) const {
    Corners points;
    points.reserve(kSegments);
    for (int i = 0; i < kSegments; ++i) {
      const double angle = 2 * kHalfSegment * i;
      points.push_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    return points;
  }

  glm::dvec3 along, u{}, v{};
};

/// Adds the faces between two circles, whose front is outside where the second is further along the axis. A
/// circle of radius 0 is a point.
void add_band(const Corners& first, const Corners& second, bool first_is_point, bool second_is_point,
              std::vector<Corners>& faces) {
  for (std::size_t i = 0; i < kSegments; ++i) {
    const std::size_t next = (i + 1) % kSegments;
    Corners& face = faces.emplace_back(Corners{first[i]});
    if (!first_is_point) face.push_back(first[next]);
    face.push_back(second[next]);
    if (!second_is_point) face.push_back(second[i]);
  }
}

/// By how much the radii of a truncated cone grow so that its 32 trapezoids have its area. With s the factor
/// and x half a segment's angle, a trapezoid is s sin x (r0 + r1) wide in its middle and
/// sqrt(h^2 + (s cos x (r0 - r1))^2) long; this is solved for s^2.
double cone_scale(double height, double difference) {
  const double h2 = height * height, d2 = difference * difference;
  const double wanted = std::pow(kHalfSegment / std::sin(kHalfSegment), 2) * (h2 + d2);
  const double slope = d2 * std::pow(std::cos(kHalfSegment), 2);
  return std::sqrt(2 * wanted / (h2 + std::sqrt(h2 * h2 + 4 * slope * wanted)));
}

double ring_scale() { return cone_scale(0, 1); }

double polar_radius(int band) { return band % kBands == 0 ? 0 : std::sin(std::numbers::pi * band / kBands); }

double polar_height(int band) { return -std::cos(std::numbers::pi * band / kBands); }

/// By how much the radius of a sphere grows so that its faces have its area.
double sphere_scale() {
  double area = 0;
  for (int k = 0; k < kBands; ++k) {
    const double r0 = polar_radius(k), r1 = polar_radius(k + 1);
    const double length =
        std::hypot(polar_height(k + 1) - polar_height(k), std::cos(kHalfSegment) * (r1 - r0));
    area += kSegments * std::sin(kHalfSegment) * (r0 + r1) * length;
  }
  return std::sqrt(4 * std::numbers::pi / area);
}

}  // namespace

std::vector<Corners> cone_faces(const glm::dvec3& centre0, const glm::dvec3& centre1, double radius0,
                                double radius1, RoundEnds ends) {
  const Axis axis(centre1 - centre0);
  const double scale = ends == RoundEnds::closed
                           ? ring_scale()
                           : cone_scale(glm::distance(centre0, centre1), radius1 - radius0);
  std::vector<Corners> faces;
  faces.reserve(kSegments);
  add_band(axis.circle(centre0, scale * radius0), axis.circle(centre1, scale * radius1), radius0 == 0,
           radius1 == 0, faces);
  return faces;
}

std::vector<Corners> ring_faces(const glm::dvec3& centre, const glm::dvec3& normal, double radius0,
                                double radius1) {
  const Axis axis(normal);
  const auto [inner, outer] = std::minmax(radius0, radius1);
  const double scale = ring_scale();
  if (inner == 0) return {axis.circle(centre, scale * outer)};
  std::vector<Corners> faces;
  faces.reserve(kSegments);
  add_band(axis.circle(centre, scale * outer), axis.circle(centre, scale * inner), false, false, faces);
  return faces;
}

std::vector<Corners> sphere_faces(const glm::dvec3& centre, double radius) {
  const Axis axis(glm::dvec3(0, 0, 1));
  const double r = radius * sphere_scale();
  std::vector<Corners> faces;
  faces.reserve(std::size_t{kSegments} * kBands);
  for (int k = 0; k < kBands; ++k) {
    const auto circle = [&](int band) {
      return axis.circle(centre + r * polar_height(band) * axis.along, r * polar_radius(band));
    };
    add_band(circle(k), circle(k + 1), k == 0, k + 1 == kBands, faces);
  }
  return faces;
}

}  // namespace fluxel

#include "tests/ward_cache/hemisphere.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace fluxel::ward_cache {

namespace {

constexpr double kPi = std::numbers::pi;

struct Axes {
  glm::dvec3 x, y;
};

/// Of the plane with this unit normal.
Axes axes_of(const glm::dvec3& n) {
  const glm::dvec3 other = std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, n));
  return {x, glm::cross(n, x)};
}

glm::dvec3 around(const Axes& axes, double angle) {
  return std::cos(angle) * axes.x + std::sin(angle) * axes.y;
}

void add(Gradient& gradient, const glm::dvec3& direction, const Rgb& change) {
  for (int c = 0; c < kChannels; ++c) gradient[static_cast<std::size_t>(c)] += change[c] * direction;
}

/// Sights of all strata.
class Hemisphere {
 public:
  Hemisphere(const glm::dvec3& normal, const Strata& strata, const Look& look)
      : rings_(strata.rings), sectors_(strata.sectors), axes_(axes_of(normal)) {
    for (int j = 0; j < rings_; ++j)
      for (int k = 0; k < sectors_; ++k) {
        const double sine = sine_at(j + 0.5);
        sights_.push_back(
            look(sine * around(axes_, angle_at(k + 0.5)) + std::sqrt(1 - sine * sine) * normal));
      }
  }

  [[nodiscard]] HemisphereLight light() const {
    HemisphereLight light;
    const double part = 1.0 / (rings_ * sectors_);  // of the projected solid angle, over pi
    double inverse = 0;
    for (int j = 0; j < rings_; ++j)
      for (int k = 0; k < sectors_; ++k) {
        const Sight& here = at(j, k);
        light.irradiance += part * here.radiosity;
        inverse += part / here.distance;
        add_rotation(j, k, part, light.rotation);
        if (j > 0) add_across_rings(j, k, light.translation);
        add_across_sectors(j, k, light.translation);
      }
    light.mean_distance = 1 / inverse;
    return light;
  }

 private:
  /// Sine of the angle to the normal after so many rings.
  [[nodiscard]] double sine_at(double rings) const { return std::sqrt(rings / rings_); }
  [[nodiscard]] double angle_at(double sectors) const { return 2 * kPi * sectors / sectors_; }
  [[nodiscard]] const Sight& at(int ring, int sector) const {
    return sights_[static_cast<std::size_t>(ring * sectors_ + (sector + sectors_) % sectors_)];
  }

  /// Turning the normal n about n x u, where u is the sector's direction, leads it towards u: the cosine of a
  /// ray grows by its sine (the rotation gradient of Ward & Heckbert 1992, whose axes run the other way).
  void add_rotation(int j, int k, double part, Gradient& rotation) const {
    const double sine = sine_at(j + 0.5), tangent = sine / std::sqrt(1 - sine * sine);
    add(rotation, around(axes_, angle_at(k + 0.5) + kPi / 2), tangent * part * at(j, k).radiosity);
  }

  /// Over an edge between two rings, as one approaches it: the outer one's part grows by cos(theta) / r a
  /// metre in angle, that is by sin(theta) cos^2(theta) 2 pi / (N r) of the projected solid angle (the
  /// translation gradient of Ward & Heckbert 1992, first sum).
  void add_across_rings(int j, int k, Gradient& translation) const {
    const double sine = sine_at(j), nearer = std::min(at(j, k).distance, at(j - 1, k).distance);
    const double grows = sine * (1 - sine * sine) * 2 / (sectors_ * nearer);  // over pi
    add(translation, around(axes_, angle_at(k + 0.5)), grows * (at(j, k).radiosity - at(j - 1, k).radiosity));
  }

  /// Likewise between two sectors, by 1 / (r sin(theta)) in angle: the integral of cos(theta) over the ring,
  /// over r (there, second sum).
  void add_across_sectors(int j, int k, Gradient& translation) const {
    const double nearer = std::min(at(j, k).distance, at(j, k - 1).distance);
    const double grows = (sine_at(j + 1) - sine_at(j)) / (kPi * nearer);
    add(translation, around(axes_, angle_at(k) + kPi / 2),
        grows * (at(j, k).radiosity - at(j, k - 1).radiosity));
  }

  int rings_, sectors_;
  Axes axes_;
  std::vector<Sight> sights_;
};

}  // namespace

HemisphereLight look_around(const glm::dvec3& normal, const Strata& strata, const Look& look) {
  return Hemisphere(normal, strata, look).light();
}

}  // namespace fluxel::ward_cache

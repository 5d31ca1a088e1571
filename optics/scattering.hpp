#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/portable_sampling.hpp"
#include "core/rgb.hpp"
#include "optics/emitters.hpp"

namespace fluxel {

/// Ways of light from a surface that it has come to.
enum class Way { diffuse, mirror, through, diffuse_through, refracted };

/// A way, and the share of the light that takes it.
struct WayShare {
  Way way = Way::diffuse;
  Rgb share{0};
};

/// The ways that light takes from one side of a surface, those of no share left out; what they leave is
/// absorbed.
class Ways {
 public:
  /// Of light that comes to the `front` or the back of a patch in a unit direction; `normal` is the patch's.
  Ways(const SideLight& side, bool front, const glm::dvec3& direction, const glm::dvec3& normal);

  [[nodiscard]] std::span<const WayShare> list() const { return std::span(list_).first(count_); }

 private:
  void add(Way way, const Rgb& share) {
    if (share != Rgb(0)) list_[count_++] = {way, share};
  }

  std::array<WayShare, 4> list_;
  std::size_t count_ = 0;
};

/// Where a photon goes that is absorbed or goes on as a whole.
struct ChosenWay {
  bool goes_on = false;
  Way way = Way::diffuse;
  Rgb colour{0};      ///< of what goes on or is absorbed, its sum that of what has come
  double rest = 0;    ///< of the number, uniform in [0, 1) again (Dmitriev 2002, equation 12)
  bool drew = false;  ///< whether a number was needed
};

/// Chooses a way, each as often as the light of `colour` [any unit, its sum above 0] that takes it; `number`
/// is called where there is a choice.
template <class Number>
[[nodiscard]] ChosenWay choose_way(const Ways& ways, const Rgb& colour, Number&& number) {
  constexpr double kCertain = 1 - 1e-12;
  const double all = colour.r + colour.g + colour.b;
  double left = -1;  // of the number; below 0 it is not drawn yet
  Rgb absorbed = colour;
  for (const WayShare& one : ways.list()) {
    const Rgb of_way = one.share * colour;
    const double chance = (of_way.r + of_way.g + of_way.b) / all;
    if (chance >= kCertain) return {true, one.way, of_way / chance, 0, false};
    if (left < 0) left = number();
    if (left < chance) return {true, one.way, of_way / chance, below_one(left / chance), true};
    left -= chance;
    absorbed -= of_way;
  }
  const double chance = (absorbed.r + absorbed.g + absorbed.b) / all;
  return {false, Way::diffuse, glm::max(absorbed, 0.0) / std::max(chance, 1 - kCertain), 0, left >= 0};
}

/// Of a unit direction, by a unit normal on either side.
[[nodiscard]] glm::dvec3 mirrored(const glm::dvec3& direction, const glm::dvec3& normal);

/// A unit direction behind a surface, the index of refraction before it being `ratio` of that behind it;
/// `normal` points to where the light comes from. Not of light that is totally reflected.
[[nodiscard]] glm::dvec3 refracted(const glm::dvec3& direction, const glm::dvec3& normal, double ratio);

/// The share of unpolarised light that is reflected (Fresnel), of which `cosine` is that of the angle to the
/// normal; 1 where it is totally reflected.
[[nodiscard]] double fresnel_reflectance(double cosine, double ratio);

/// The index of refraction before a side of a clear body's surface over that behind it.
[[nodiscard]] inline double refraction_ratio(double index, bool front) { return front ? 1 / index : index; }

/// Where light goes on from a surface.
struct Departure {
  glm::dvec3 direction{0};  ///< unit
  bool same_side = true;    ///< as it has come from
};

/// By a way that needs no numbers, of light that comes to the front or the back of a patch in a unit
/// direction.
[[nodiscard]] Departure straight_departure(Way way, const SurfaceOptics& optics, bool front,
                                           const glm::dvec3& direction, const glm::dvec3& normal);

}  // namespace fluxel

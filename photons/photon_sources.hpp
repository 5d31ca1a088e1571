#pragma once

#include <algorithm>
#include <vector>

#include "core/sampling.hpp"
#include "optics/emitters.hpp"
#include "optics/luminaire_emission.hpp"
#include "sampling/cuda/chosen_part.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A photon as it leaves what emits it. All photons carry the same power; what differs is its colour.
struct EmittedPhoton {
  Ray ray;        ///< its direction a unit vector
  Rgb colour{1};  ///< of mean 1
};

/// As cosine_direction, but not along the surface, where coordinates of 0 lead: between mirrors such a photon
/// would go on for ever.
[[nodiscard]] inline glm::dvec3 even_direction(double u, double v, const glm::dvec3& normal) {
  constexpr double kLeast = 0x1p-33;
  return cosine_direction(std::clamp(u, kLeast, 1 - kLeast), std::clamp(v, kLeast, 1 - kLeast), normal);
}

/// All that emits light, or heat: uncovered emitting sides and luminaires. Photons leave each as often as its
/// power, the mean of the channels, says.
class PhotonSources {
 public:
  /// The scene must outlive this. Throws InputError where a flux of heat is drawn: photons bring power alone.
  explicit PhotonSources(const RayScene& ray_scene);

  /// Of the mean of the channels [W] or [lm].
  [[nodiscard]] double power() const { return ends_.empty() ? 0 : ends_.back(); }

  /// Whether photons of the same numbers leave both alike.
  [[nodiscard]] bool emits_as(const PhotonSources& other) const;

  /// By two numbers for the place, of which the first chooses what emits too, and two for the direction; of a
  /// luminaire by two for the direction, the first chooses too, and two for the place where it is not a
  /// point.
  template <class Numbers>
  [[nodiscard]] EmittedPhoton emit(Numbers& numbers) const {
    const cuda::ChosenPart chosen = cuda::chosen_part(ends_.data(), ends_.size(), numbers.next());
    numbers.keep(below_one(chosen.rest));
    const double first = numbers.next_of_choice(), second = numbers.next();
    if (chosen.number < sides_.size()) {
      const EmittingSide& side = sides_[chosen.number];
      const glm::dvec3 place = surface_point(side.outline, first, second);
      const double u = numbers.next(), v = numbers.next();
      return {{place + lift_ * side.normal, even_direction(u, v, side.normal)}, colours_[chosen.number]};
    }
    const LuminaireEmission& emission = luminaires_[chosen.number - sides_.size()];
    double u = 0.5, v = 0.5;
    if (!emission.is_point()) u = numbers.next(), v = numbers.next();
    const EmittedRay ray = emission.ray({first, second, u, v}, lift_);
    return {{ray.from, ray.direction}, colours_[chosen.number]};
  }

 private:
  double lift_;
  std::vector<EmittingSide> sides_;
  std::vector<LuminaireEmission> luminaires_;
  std::vector<double> ends_;  // running sums of the power of sides, then of luminaires
  std::vector<Rgb> colours_;  // of each
};

}  // namespace fluxel

#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "core/sampling.hpp"
#include "optics/scattering.hpp"
#include "photons/photon_sources.hpp"
#include "photons/photon_tally.hpp"
#include "photons/receiver_crossings.hpp"
#include "subdivision/element_finder.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

/// How a photon's path has ended.
struct PhotonEnd {
  PhotonFate fate = PhotonFate::lost;
  Rgb colour{0};  ///< then
  std::uint64_t segments = 0;
  bool met = false;  ///< any surface
};

/// A scene as photons meet it. They go from what emits and are absorbed, reflected, transmitted or refracted
/// as wholes, so that each keeps its power (importance sampling; Dmitriev 2002); where they come to a side of
/// an element or through a cell of a receiver they count. Where a photon goes depends on its numbers alone.
/// Queries may run from many threads at once.
class PhotonScene {
 public:
  /// All must outlive this. No elements: none are measured. `receivers`: those that are counted.
  PhotonScene(const RayScene& ray_scene, const ElementView& mesh, std::span<const Receiver> receivers);

  [[nodiscard]] const PhotonSources& sources() const { return sources_; }
  /// Of a tally with so many parts.
  [[nodiscard]] TallyShape shape(std::size_t parts, bool has_squares) const;

  /// Follows a photon by further numbers; calls arrives(kind, slot, colour) wherever it counts: kind 0 is
  /// elements, receivers are counted from 1.
  template <class Numbers, class Arrives>
  PhotonEnd follow(EmittedPhoton photon, Numbers& numbers, Arrives&& arrives) const {
    PhotonEnd end;
    while (end.segments < kMostSteps) {
      ++end.segments;
      const MetSide met = first_side_.meet(photon.ray.origin, photon.ray.direction);
      const bool is_met = met.patch != kNoPatch;
      crossings_.meet(
          photon.ray, is_met ? met.t : std::numeric_limits<double>::infinity(),
          [&](std::size_t receiver, std::size_t slot) { arrives(1 + receiver, slot, photon.colour); });
      if (!is_met) {
        end.fate = PhotonFate::escaped;
        end.colour = photon.colour;
        return end;
      }
      end.met = true;
      const glm::dvec3 at = photon.ray.origin + met.t * photon.ray.direction;
      if (const std::size_t slot = slot_at(met, at); slot != kNoSlot) arrives(0, slot, photon.colour);
      if (!scatter(met, at, numbers, photon)) {
        end.fate = PhotonFate::absorbed;
        end.colour = photon.colour;
        return end;
      }
    }
    end.colour = photon.colour;
    return end;
  }

 private:
  static constexpr std::size_t kNoSlot = static_cast<std::size_t>(-1);

  [[nodiscard]] std::size_t slot_at(const MetSide& met, const glm::dvec3& at) const;

  /// Whether the photon goes on, and then how; else it has the colour that is absorbed.
  template <class Numbers>
  bool scatter(const MetSide& met, const glm::dvec3& at, Numbers& numbers, EmittedPhoton& photon) const {
    const SideLight& side = sides_[index(met.patch)][met.front ? 0 : 1];
    const glm::dvec3& normal = ray_scene_.scene().patch(met.patch).normal;
    const Ways ways(side, met.front, photon.ray.direction, normal);
    const ChosenWay chosen = choose_way(ways, photon.colour, [&] { return numbers.next_of_choice(); });
    photon.colour = chosen.colour;
    if (!chosen.goes_on) return false;
    const glm::dvec3 towards = met.front ? normal : -normal;  // to where the photon has come from
    if (chosen.drew) numbers.keep(chosen.rest);
    Departure to;
    if (chosen.way == Way::diffuse || chosen.way == Way::diffuse_through) {
      to.same_side = chosen.way == Way::diffuse;
      const double u = numbers.next_of_choice(), v = numbers.next();
      to.direction = even_direction(u, v, to.same_side ? towards : -towards);
    } else {
      to = straight_departure(chosen.way, side.optics, met.front, photon.ray.direction, normal);
    }
    photon.ray = {at + (to.same_side ? lift_ : -lift_) * towards, to.direction};
    return true;
  }

  const RayScene& ray_scene_;
  FirstSide first_side_;
  PhotonSources sources_;
  double lift_;
  std::size_t elements_;
  bool two_sided_ = false;
  ElementFinder finder_;
  ReceiverCrossings crossings_;
  std::vector<std::size_t> cells_;               // of each receiver
  std::vector<std::array<SideLight, 2>> sides_;  // front and back of each patch
};

}  // namespace fluxel

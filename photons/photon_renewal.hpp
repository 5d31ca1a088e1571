#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "photons/photon_scene.hpp"
#include "photons/photon_tally.hpp"

namespace fluxel {

/// Photons of Halton points that go again after a change of the scene (selective photon tracing: Dmitriev et
/// al. 2002): what a photon has brought in the scene before is taken away, and what it brings in the scene
/// after it is added, in whole numbers, so that where nothing differs nothing is left. When all have gone
/// again the tally is that of the scene after.
class PhotonRenewal {
 public:
  /// All must outlive this. `slots`: where each slot of the scene before is in the scene after; kNowhere
  /// where it is not.
  PhotonRenewal(const PhotonScene& before, const PhotonScene& after, std::vector<std::size_t> slots)
      : before_(before), after_(after), slots_(std::move(slots)) {}

  static constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

  /// A tally of the scene after that has what one of the scene before has, as far as slots are the same.
  [[nodiscard]] PhotonTally taken_over(const PhotonTally& before) const;

  /// Photons of these indices, as far apart as `step`.
  struct Indices {
    std::uint64_t first = 0, last = 0, step = 1;  ///< up to, not with, last
  };
  /// They go again, by one thread; the difference is added to the tally of the scene after, whose values may
  /// wrap around zero meanwhile. Calls changed(index) of those that have brought anything else than before,
  /// and returns how many.
  std::uint64_t renew(const Indices& indices, PhotonTally& difference,
                      const std::function<void(std::uint64_t)>& changed) const;

  /// Where each slot of the scene before is in the scene after, elements being the same where their outlines
  /// are, and receivers one by one.
  [[nodiscard]] static std::vector<std::size_t> same_slots(const ElementView& before,
                                                           const TallyShape& shape_before,
                                                           const ElementView& after,
                                                           const TallyShape& shape_after);

 private:
  const PhotonScene& before_;
  const PhotonScene& after_;
  std::vector<std::size_t> slots_;
};

}  // namespace fluxel

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "photons/photon_scene.hpp"
#include "photons/photon_tally.hpp"
#include "photons/trace_photons.hpp"

namespace fluxel {

/// What one photon has brought to each cell that it has met.
class CellSums {
 public:
  void add(std::size_t slot, const Rgb& colour) {
    for (auto& [of, sum] : sums_)
      if (of == slot) {
        sum += colour;
        return;
      }
    sums_.emplace_back(slot, colour);
  }
  void move_to(PhotonTally& tally) {
    for (const auto& [slot, sum] : sums_) tally.add_square(slot, sum);
    sums_.clear();
  }

 private:
  std::vector<std::pair<std::size_t, Rgb>> sums_;
};

/// Follows the photons of a range one after another, by numbers of one thread's own. `emit` begins each.
template <class Numbers, class Emit>
void trace_task(const PhotonScene& scene, Numbers& numbers, Emit&& emit, const PhotonRange& range,
                PhotonTally& tally) {
  CellSums cells;
  const std::uint64_t drawn_before = numbers.drawn();
  std::uint64_t met = 0, segments = 0;
  std::array<std::uint64_t, Numbers::kParts> sent{};
  std::vector<std::uint64_t> received(1 + tally.shape().cells.size(), 0);
  for (std::uint64_t index = range.first; index < range.last; ++index) {
    const std::size_t part = numbers.start(index);
    ++sent[part];
    const PhotonEnd end =
        scene.follow(emit(numbers), numbers, [&](std::size_t kind, std::size_t slot, const Rgb& colour) {
          tally.add(slot, part, colour);
          ++received[kind];
          if (kind > 0 && tally.shape().has_squares) cells.add(slot, colour);
        });
    cells.move_to(tally);
    tally.add_end(end.fate, end.colour);
    segments += end.segments;
    met += end.met ? 1 : 0;
  }
  tally.add(PhotonCount::sent, range.last - range.first);
  tally.add(PhotonCount::met, met);
  tally.add(PhotonCount::segments, segments);
  tally.add(PhotonCount::coordinates, numbers.drawn() - drawn_before);
  for (std::size_t part = 0; part < sent.size(); ++part) tally.add_sent(part, sent[part]);
  for (std::size_t kind = 0; kind < received.size(); ++kind) tally.add_received(kind, received[kind]);
}

/// The same of photons as the scene emits them.
template <class Numbers>
void trace_task(const PhotonScene& scene, Numbers& numbers, const PhotonRange& range, PhotonTally& tally) {
  trace_task(
      scene, numbers, [&](Numbers& of) { return scene.sources().emit(of); }, range, tally);
}

}  // namespace fluxel

#include "photons/trace_photons.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <utility>
#include <vector>

#include "photons/photon_numbers.hpp"

namespace fluxel {

namespace {

using SobolPhotons = PhotonNumbers<PlainPoints<SobolSequence>>;
using HaltonPhotons = PhotonNumbers<PlainPoints<HaltonSequence>>;
using RandomPhotons = PhotonNumbers<RandomPoints>;
using ScrambledPhotons = PhotonNumbers<ScrambledPoints>;

/// Photons of a task, which has numbers of its own.
constexpr std::uint64_t kOfTask = 4096;

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

template <class Numbers>
void trace_task(const PhotonScene& scene, std::uint64_t seed, const PhotonRange& range, PhotonTally& tally) {
  Numbers numbers(seed);
  CellSums cells;
  std::uint64_t met = 0, segments = 0;
  std::array<std::uint64_t, Numbers::kParts> sent{};
  std::vector<std::uint64_t> received(1 + tally.shape().cells.size(), 0);
  for (std::uint64_t index = range.first; index < range.last; ++index) {
    const std::size_t part = numbers.start(index);
    ++sent[part];
    const PhotonEnd end = scene.follow(numbers, [&](std::size_t kind, std::size_t slot, const Rgb& colour) {
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
  tally.add(PhotonCount::coordinates, numbers.drawn());
  for (std::size_t part = 0; part < sent.size(); ++part) tally.add_sent(part, sent[part]);
  for (std::size_t kind = 0; kind < received.size(); ++kind) tally.add_received(kind, received[kind]);
}

template <class Numbers>
void trace_tasks(const PhotonScene& scene, std::uint64_t seed, const PhotonRange& range,
                 PhotonTally& tally) {
  const std::uint64_t tasks = (range.last - range.first + kOfTask - 1) / kOfTask;
  tbb::parallel_for(std::uint64_t{0}, tasks, [&](std::uint64_t task) {
    const std::uint64_t first = range.first + task * kOfTask;
    trace_task<Numbers>(scene, seed, {first, std::min(first + kOfTask, range.last)}, tally);
  });
}

}  // namespace

std::size_t parts_of(Sequence sequence) {
  return sequence == Sequence::scrambled ? ScrambledPhotons::kParts : SobolPhotons::kParts;
}

void trace_photons(const PhotonScene& scene, const PhotonPoints& points, const PhotonRange& range,
                   PhotonTally& tally) {
  switch (points.sequence) {
    case Sequence::sobol:
      return trace_tasks<SobolPhotons>(scene, points.seed, range, tally);
    case Sequence::halton:
      return trace_tasks<HaltonPhotons>(scene, points.seed, range, tally);
    case Sequence::random:
      return trace_tasks<RandomPhotons>(scene, points.seed, range, tally);
    case Sequence::scrambled:
      return trace_tasks<ScrambledPhotons>(scene, points.seed, range, tally);
  }
}

}  // namespace fluxel

#include "photons/trace_photons.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "photons/photon_numbers.hpp"
#include "photons/photon_task.hpp"

namespace fluxel {

namespace {

using SobolPhotons = PhotonNumbers<PlainPoints<SobolSequence>>;
using HaltonPhotons = PhotonNumbers<PlainPoints<HaltonSequence>>;
using RandomPhotons = PhotonNumbers<RandomPoints>;
using ScrambledPhotons = PhotonNumbers<ScrambledPoints>;

/// Photons of a task, which has numbers of its own.
constexpr std::uint64_t kOfTask = 4096;

template <class Numbers>
void trace_tasks(const PhotonScene& scene, std::uint64_t seed, const PhotonRange& range, PhotonTally& tally) {
  const std::uint64_t tasks = (range.last - range.first + kOfTask - 1) / kOfTask;
  tbb::parallel_for(std::uint64_t{0}, tasks, [&](std::uint64_t task) {
    const std::uint64_t first = range.first + task * kOfTask;
    Numbers numbers(seed);
    trace_task(scene, numbers, {first, std::min(first + kOfTask, range.last)}, tally);
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

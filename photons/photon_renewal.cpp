#include "photons/photon_renewal.hpp"

#include <array>
#include <cstring>
#include <map>

#include "photons/photon_numbers.hpp"

namespace fluxel {

namespace {

using Numbers = PhotonNumbers<PlainPoints<HaltonSequence>>;

/// All that a photon adds to a tally.
struct PhotonRecord {
  struct Arrival {
    std::size_t kind, slot;
    Rgb colour;

    bool operator==(const Arrival&) const = default;
  };
  std::size_t part = 0;
  std::uint64_t coordinates = 0;
  PhotonEnd end;
  std::vector<Arrival> arrivals;

  [[nodiscard]] bool brings_the_same(const PhotonRecord& other) const {
    return end.fate == other.end.fate && end.colour == other.end.colour &&
           end.segments == other.end.segments && end.met == other.end.met &&
           coordinates == other.coordinates && arrivals == other.arrivals;
  }
};

void follow(const PhotonScene& scene, std::uint64_t index, Numbers& numbers, PhotonRecord& record) {
  record.arrivals.clear();
  const std::uint64_t drawn = numbers.drawn();
  record.part = numbers.start(index);
  record.end = scene.follow(scene.sources().emit(numbers), numbers,
                            [&](std::size_t kind, std::size_t slot, const Rgb& colour) {
                              record.arrivals.push_back({kind, slot, colour});
                            });
  record.coordinates = numbers.drawn() - drawn;
}

/// Adds it or takes it away.
void add(const PhotonRecord& record, PhotonTally& tally, PhotonTally::Sign sign) {
  const std::uint64_t one = sign == PhotonTally::Sign::plus ? 1 : ~std::uint64_t{0};
  for (const PhotonRecord::Arrival& at : record.arrivals) {
    tally.add_received(at.kind, one);
    if (at.slot != PhotonRenewal::kNowhere) tally.add(at.slot, record.part, at.colour, sign);
  }
  tally.add_end(record.end.fate, record.end.colour, sign);
  tally.add(PhotonCount::met, record.end.met ? one : 0);
  tally.add(PhotonCount::segments, one * record.end.segments);
  tally.add(PhotonCount::coordinates, one * record.coordinates);
}

using OutlineKey = std::array<float, 12>;

OutlineKey key_of(const Outline<glm::vec3>& outline) {
  OutlineKey key{};
  for (std::size_t k = 0; k < outline.corners; ++k)
    for (int axis = 0; axis < 3; ++axis)
      key[3 * k + static_cast<std::size_t>(axis)] = outline.corner[k][axis];
  return key;
}

}  // namespace

PhotonTally PhotonRenewal::taken_over(const PhotonTally& before) const {
  PhotonTally after(after_.shape(before.shape().parts, before.shape().has_squares));
  after.take_over(before, slots_);
  return after;
}

std::uint64_t PhotonRenewal::renew(const Indices& indices, PhotonTally& difference,
                                   const std::function<void(std::uint64_t)>& changed) const {
  Numbers numbers(1);
  PhotonRecord old, now;
  std::uint64_t count = 0;
  for (std::uint64_t index = indices.first; index < indices.last; index += indices.step) {
    follow(before_, index, numbers, old);
    for (PhotonRecord::Arrival& at : old.arrivals) at.slot = slots_[at.slot];
    follow(after_, index, numbers, now);
    if (now.brings_the_same(old)) continue;
    ++count;
    changed(index);
    add(old, difference, PhotonTally::Sign::minus);
    add(now, difference, PhotonTally::Sign::plus);
  }
  return count;
}

std::vector<std::size_t> PhotonRenewal::same_slots(const ElementView& before, const TallyShape& shape_before,
                                                   const ElementView& after, const TallyShape& shape_after) {
  std::multimap<OutlineKey, std::size_t> places;
  for (std::size_t k = 0; k < after.outlines.size(); ++k) places.emplace(key_of(after.outlines[k]), k);
  std::vector<std::size_t> slots(shape_before.slots(), kNowhere);
  const bool has_backs =
      shape_before.sides > before.elements.size() && shape_after.sides > after.elements.size();
  for (std::size_t k = 0; k < before.elements.size(); ++k) {
    const auto found = places.find(key_of(before.outlines[k]));
    if (found == places.end()) continue;
    slots[k] = found->second;
    if (has_backs) slots[k + before.elements.size()] = found->second + after.elements.size();
    places.erase(found);  // each is taken once
  }
  for (std::size_t cell = shape_before.sides; cell < slots.size(); ++cell)
    slots[cell] = shape_after.sides + (cell - shape_before.sides);
  return slots;
}

}  // namespace fluxel

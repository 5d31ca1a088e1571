#include "solver/discretisation_error.hpp"

#include <glm/geometric.hpp>
#include <utility>

#include "core/second_moments.hpp"
#include "solver/reductions.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

namespace {

/// Whether element i + 1 of the same tile continues the patch of element i on the side that `unknown` i is.
bool continues(std::span<const Element> elements, const Unknowns& unknowns, std::size_t unknown) {
  const std::size_t i = unknown % elements.size();
  return i + 1 < elements.size() && (i + 1) % kTileSize != 0 && elements[i].patch == elements[i + 1].patch &&
         unknowns.area[unknown] > 0 && unknowns.area[unknown + 1] > 0;
}

/// Of an element's points from its centroid [m2].
double mean_squared_distance(const Element& element) {
  return SecondMoments{static_cast<double>(element.minor_variance), glm::dvec3(element.elongation)}.trace();
}

}  // namespace

DiscretisationError::DiscretisationError(std::span<const Element> elements, const Unknowns& unknowns,
                                         Ranks ranks)
    : ranks_(std::move(ranks)) {
  area_ = sum_over<double>(ranks_, unknowns.size(), [&](std::size_t unknown) {
    const bool has_next = continues(elements, unknowns, unknown);
    const bool has_last = unknown % elements.size() > 0 && continues(elements, unknowns, unknown - 1);
    return has_next || has_last ? unknowns.area[unknown] : 0.0;
  });
  for (std::size_t unknown = 0; unknown < unknowns.size(); ++unknown) {
    if (!continues(elements, unknowns, unknown)) continue;
    const std::size_t i = unknown % elements.size();
    const glm::dvec3 way = glm::dvec3(elements[i + 1].centroid) - glm::dvec3(elements[i].centroid);
    const double squared = glm::dot(way, way);
    if (!(squared > 0)) continue;
    // An element between two others takes the mean of both slopes' squares.
    double weight = 0;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const bool both = k == 0 ? i > 0 && continues(elements, unknowns, unknown - 1)
                               : continues(elements, unknowns, unknown + 1);
      weight +=
          unknowns.area[unknown + k] * mean_squared_distance(elements[i + k]) / squared * (both ? 0.5 : 1);
    }
    links_.push_back({static_cast<std::uint32_t>(unknown), static_cast<std::uint32_t>(unknown + 1),
                      static_cast<float>(weight)});
  }
  known_ = is_any(ranks_, !links_.empty());
}

template <class Value>
Value DiscretisationError::estimate(std::span<const Value> B) const {
  const Value sum = sum_over<Value>(ranks_, links_.size(), [&](std::size_t k) {
    const Value difference = B[links_[k].second] - B[links_[k].first];
    return static_cast<double>(links_[k].weight) * difference * difference;
  });
  return area_ > 0 ? glm::sqrt(sum / area_) : Value(0);
}

template double DiscretisationError::estimate(std::span<const double>) const;
template Rgb DiscretisationError::estimate(std::span<const Rgb>) const;

}  // namespace fluxel

#include "solver/discretisation_error.hpp"

#include <glm/geometric.hpp>

#include "core/second_moments.hpp"
#include "solver/channels.hpp"

namespace fluxel {

namespace {

/// Whether element i + 1 continues the patch of element i on the side that `unknown` i is.
bool continues(std::span<const Element> elements, const Unknowns& unknowns, std::size_t unknown) {
  const std::size_t i = unknown % elements.size();
  return i + 1 < elements.size() && elements[i].patch == elements[i + 1].patch &&
         unknowns.area[unknown] > 0 && unknowns.area[unknown + 1] > 0;
}

/// Of an element's points from its centroid [m2].
double mean_squared_distance(const Element& element) {
  return SecondMoments{static_cast<double>(element.minor_variance), glm::dvec3(element.elongation)}.trace();
}

}  // namespace

DiscretisationError::DiscretisationError(std::span<const Element> elements, const Unknowns& unknowns) {
  for (std::size_t unknown = 0; unknown < unknowns.size(); ++unknown) {
    const bool has_next = continues(elements, unknowns, unknown);
    const bool has_last = unknown % elements.size() > 0 && continues(elements, unknowns, unknown - 1);
    if (has_next || has_last) area_ += unknowns.area[unknown];
  }
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
}

template <class Value>
Value DiscretisationError::estimate(std::span<const Value> B) const {
  Value sum(0);
  for (const Link& link : links_) {
    const Value difference = B[link.second] - B[link.first];
    sum += static_cast<double>(link.weight) * difference * difference;
  }
  return area_ > 0 ? glm::sqrt(sum / area_) : Value(0);
}

template double DiscretisationError::estimate(std::span<const double>) const;
template Rgb DiscretisationError::estimate(std::span<const Rgb>) const;

}  // namespace fluxel

#include "solver/unknowns.hpp"

#include <bit>

#include "solver/channels.hpp"

namespace fluxel {

UnknownCount count_unknowns(std::span<const Element> elements) {
  UnknownCount count;
  for (const Element& element : elements) {
    count.two_sided = count.two_sided || (element.sides & kBack) != 0;
    count.active += static_cast<std::size_t>(std::popcount(element.sides));
  }
  return count;
}

Unknowns make_unknowns(std::span<const Element> elements, std::span<const Material> materials) {
  const UnknownCount count = count_unknowns(elements);
  Unknowns unknowns;
  unknowns.elements = elements.size();
  unknowns.two_sided = count.two_sided;
  unknowns.active = count.active;
  const std::size_t size = elements.size() * (unknowns.two_sided ? 2 : 1);
  unknowns.E.assign(size, Rgb(0));
  unknowns.rho.assign(size, Rgb(0));
  unknowns.area.assign(size, 0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Element& element = elements[i];
    const Material& material = materials[index(element.material)];
    if ((element.sides & kFront) != 0) {
      unknowns.E[i] = material.E;
      unknowns.rho[i] = material.rho;
      unknowns.area[i] = static_cast<double>(element.area);
    }
    if ((element.sides & kBack) != 0) {
      unknowns.E[elements.size() + i] = material.back_exitance();
      unknowns.rho[elements.size() + i] = material.rho;
      unknowns.area[elements.size() + i] = static_cast<double>(element.area);
    }
  }
  return unknowns;
}

Rgb area_mean(const Unknowns& unknowns, std::span<const Rgb> x) { return area_mean<Rgb>(unknowns.area, x); }

}  // namespace fluxel

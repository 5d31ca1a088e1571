#include "solver/unknowns.hpp"

#include <bit>

namespace fluxel {

UnknownCount count_unknowns(std::span<const Element> elements) {
  UnknownCount count;
  for (const Element& element : elements) {
    count.two_sided = count.two_sided || (element.sides & kBack) != 0;
    count.active += static_cast<std::size_t>(std::popcount(element.sides));
  }
  return count;
}

std::vector<Rgb> sources(const Unknowns& unknowns) {
  std::vector<Rgb> sources(unknowns.size());
  for (std::size_t i = 0; i < sources.size(); ++i) sources[i] = unknowns.source(i);
  return sources;
}

Unknowns make_unknowns(std::span<const Element> elements, std::span<const Material> materials) {
  return make_unknowns(elements, materials, count_unknowns(elements).two_sided);
}

Unknowns make_unknowns(std::span<const Element> elements, std::span<const Material> materials,
                       bool two_sided) {
  Unknowns unknowns;
  unknowns.elements = elements.size();
  unknowns.two_sided = two_sided;
  unknowns.active = count_unknowns(elements).active;
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

Rgb area_mean(std::span<const double> area, std::span<const Rgb> x) {
  Rgb sum(0);
  double whole = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += area[i] * x[i];
    whole += area[i];
  }
  return whole > 0 ? sum / whole : Rgb(0);
}

Rgb area_mean(const Unknowns& unknowns, std::span<const Rgb> x) { return area_mean(unknowns.area, x); }

}  // namespace fluxel

#include "output/solution_vtu.hpp"

#include <fmt/format.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/thermal.hpp"
#include "core/units.hpp"
#include "output/elements/element_file.hpp"
#include "output/elements/vtu_writer.hpp"
#include "output/version_text.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

namespace {

CellArray colours(std::string name, std::span<const Rgb> values) {
  std::vector<float> numbers;
  numbers.reserve(kChannels * values.size());
  for (const Rgb& value : values)
    for (int c = 0; c < kChannels; ++c) numbers.push_back(static_cast<float>(value[c]));
  return {std::move(name), kChannels, std::move(numbers)};
}

template <class Number>
CellArray numbers_of(std::string name, std::span<const Element> elements, const Number& number) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(elements.size());
  for (const Element& element : elements) numbers.push_back(number(element));
  return {std::move(name), 1, std::move(numbers)};
}

/// Of one side of all elements, whose unknowns begin at `first`; 0 where a side is none.
class SideArrays {
 public:
  SideArrays(const RunRecord& record, const Unknowns& unknowns, bool back)
      : record_(record),
        unknowns_(unknowns),
        count_(record.solution.subdivided.mesh.elements.size()),
        first_(back ? count_ : 0),
        suffix_(back ? "_back" : "") {}

  void add_to(std::vector<CellArray>& cells) const {
    const Radiosity& found = *record_.solution.radiosity;
    cells.push_back(colours("radiosity" + suffix_, side(found.B)));
    cells.push_back(colours("irradiance" + suffix_, side(found.H)));
    cells.push_back(colours("exitance" + suffix_, side(unknowns_.E)));
    cells.push_back(colours("reflectance" + suffix_, side(unknowns_.rho)));
    if (record_.options.thermal) add_heat(cells);
  }

 private:
  [[nodiscard]] std::span<const Rgb> side(const std::vector<Rgb>& values) const {
    return std::span(values).subspan(first_, count_);
  }

  [[nodiscard]] const ThermalSurface& surface_of(std::size_t element) const {
    return *record_.scene.materials[index(record_.solution.subdivided.mesh.elements[element].material)]
                .thermal;
  }

  void add_heat(std::vector<CellArray>& cells) const {
    const std::vector<Rgb>& H = record_.solution.radiosity->H;
    std::vector<float> temperature(count_), flux(count_), emissivity(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t unknown = first_ + i;
      if (unknowns_.area[unknown] == 0) continue;
      const ThermalSurface& surface = surface_of(i);
      temperature[i] = static_cast<float>(
          in_unit(temperature_of(black_exitance(surface, H[unknown].r)), record_.scene.temperature_unit));
      flux[i] = static_cast<float>(net_flux(surface, H[unknown].r));
      emissivity[i] = static_cast<float>(emissivity_of(surface, H[unknown].r));
    }
    cells.push_back({"temperature" + suffix_, 1, std::move(temperature)});
    cells.push_back({"net_flux" + suffix_, 1, std::move(flux)});
    cells.push_back({"emissivity" + suffix_, 1, std::move(emissivity)});
  }

  const RunRecord& record_;
  const Unknowns& unknowns_;
  std::size_t count_, first_;
  std::string suffix_;
};

/// With E and rho as they are at the temperatures of the solution.
Unknowns unknowns_at_solution(const RunRecord& record) {
  const ElementView& mesh = record.solution.subdivided.mesh;
  Unknowns unknowns = make_unknowns(mesh.elements, record.scene.materials);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Material& material =
        record.scene.materials[index(mesh.elements[i % mesh.elements.size()].material)];
    if (unknowns.area[i] == 0 || !material.has_convection()) continue;
    const ThermalExchange exchange = linearised(*material.thermal, record.solution.radiosity->H[i].r);
    unknowns.E[i] = Rgb(exchange.E);
    unknowns.rho[i] = Rgb(exchange.rho);
  }
  return unknowns;
}

/// "0 floor, 1 wall"
std::string numbered(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    text += fmt::format("{}{} {}", k == 0 ? "" : ", ", k, names[k]);
  return text;
}

std::string about(const RunRecord& record) {
  std::vector<std::string> materials;
  for (const Material& material : record.scene.materials) materials.push_back(material.name);
  return fmt::format("{}\nlengths in m, radiosity in {}{}\ngroups: {}\nmaterials: {}\n", version_text(),
                     unit_names(record.scene.units).exitance,
                     record.options.thermal
                         ? fmt::format(", temperature in {}", name_of(record.scene.temperature_unit))
                         : "",
                     numbered(record.scene.groups), numbered(materials));
}

}  // namespace

void write_solution_vtu(const std::filesystem::path& file, const RunRecord& record) {
  const ElementView& mesh = record.solution.subdivided.mesh;
  const Unknowns unknowns = unknowns_at_solution(record);
  std::vector<CellArray> cells;
  SideArrays(record, unknowns, false).add_to(cells);
  if (unknowns.two_sided) SideArrays(record, unknowns, true).add_to(cells);
  cells.push_back(numbers_of("patch", mesh.elements,
                             [](const Element& of) { return static_cast<std::uint32_t>(of.patch); }));
  cells.push_back(numbers_of("group", mesh.elements, [&](const Element& of) {
    return static_cast<std::uint32_t>(record.scene.patch(of.patch).group);
  }));
  cells.push_back(numbers_of("material", mesh.elements,
                             [](const Element& of) { return static_cast<std::uint32_t>(of.material); }));
  cells.push_back(numbers_of("sides", mesh.elements, [](const Element& of) { return of.sides; }));
  std::vector<FieldNumber> fields;
  if (record.solution.stated_error) fields.push_back({"stated_error", *record.solution.stated_error});
  write_vtu(file, indexed_mesh(file_elements(record.scene, mesh).outlines), cells, fields, about(record));
}

}  // namespace fluxel

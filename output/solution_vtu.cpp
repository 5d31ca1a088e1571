#include "output/solution_vtu.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/options.hpp"
#include "core/thermal.hpp"
#include "core/units.hpp"
#include "output/elements/element_file.hpp"
#include "output/elements/vtu_writer.hpp"
#include "output/outcome.hpp"
#include "output/surface_error.hpp"
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

/// What the file shows: elements, or a mesh of its own.
struct ShownMesh {
  ElementView mesh;
  Unknowns unknowns;
  std::span<const Rgb> H, noise_of_H;  // noise: of a mesh of its own
  std::vector<Rgb> B;
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

ShownMesh shown_mesh(const RunRecord& record) {
  const Solution& solution = record.solution;
  const bool is_baked = solution.mesh && !solution.mesh->H.empty();
  ShownMesh shown;
  shown.mesh = is_baked ? ElementView(solution.mesh->mesh) : solution.subdivided.mesh;
  if (!is_baked) {
    shown.unknowns = unknowns_at_solution(record);
    shown.H = solution.radiosity->H;
    shown.B = solution.radiosity->B;
    return shown;
  }
  shown.unknowns = make_unknowns(shown.mesh.elements, record.scene.materials);
  shown.H = solution.mesh->H;
  shown.noise_of_H = solution.mesh->noise_of_H;
  for (std::size_t k = 0; k < shown.H.size(); ++k)
    shown.B.push_back(shown.unknowns.E[k] + shown.unknowns.rho[k] * shown.H[k]);
  return shown;
}

/// Of one side of all faces; 0 where a side is no unknown.
class SideArrays {
 public:
  SideArrays(const RunRecord& record, const ShownMesh& shown, bool back)
      : record_(record),
        shown_(shown),
        count_(shown.mesh.elements.size()),
        first_(back ? count_ : 0),
        suffix_(back ? "_back" : "") {}

  void add_to(std::vector<CellArray>& cells) const {
    cells.push_back(colours("radiosity" + suffix_, side(shown_.B)));
    cells.push_back(colours("irradiance" + suffix_, side(shown_.H)));
    cells.push_back(colours("exitance" + suffix_, side(shown_.unknowns.E)));
    cells.push_back(colours("reflectance" + suffix_, side(shown_.unknowns.rho)));
    if (!shown_.noise_of_H.empty()) add_noise(cells);
    if (record_.options.thermal) add_heat(cells);
  }

 private:
  [[nodiscard]] std::span<const Rgb> side(std::span<const Rgb> values) const {
    return values.subspan(first_, count_);
  }

  void add_noise(std::vector<CellArray>& cells) const {
    const std::optional<Rgb> common = surface_error(record_);
    std::vector<Rgb> noise, error;
    for (std::size_t k = first_; k < first_ + count_; ++k) {
      noise.push_back(shown_.unknowns.rho[k] * shown_.noise_of_H[k]);
      const bool is_unknown = shown_.unknowns.area[k] > 0;
      error.push_back(is_unknown && common ? error_with_noise(*common, noise.back()) : Rgb(0));
    }
    cells.push_back(colours("noise" + suffix_, noise));
    if (common) cells.push_back(colours("error" + suffix_, error));
  }

  [[nodiscard]] const ThermalSurface& surface_of(std::size_t element) const {
    return *record_.scene.materials[index(shown_.mesh.elements[element].material)].thermal;
  }

  void add_heat(std::vector<CellArray>& cells) const {
    std::vector<float> temperature(count_), flux(count_), emissivity(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t unknown = first_ + i;
      if (shown_.unknowns.area[unknown] == 0) continue;
      const ThermalSurface& surface = surface_of(i);
      const double H = shown_.H[unknown].r;
      temperature[i] = static_cast<float>(
          in_unit(temperature_of(black_exitance(surface, H)), record_.scene.temperature_unit));
      flux[i] = static_cast<float>(net_flux(surface, H));
      emissivity[i] = static_cast<float>(emissivity_of(surface, H));
    }
    cells.push_back({"temperature" + suffix_, 1, std::move(temperature)});
    cells.push_back({"net_flux" + suffix_, 1, std::move(flux)});
    cells.push_back({"emissivity" + suffix_, 1, std::move(emissivity)});
  }

  const RunRecord& record_;
  const ShownMesh& shown_;
  std::size_t count_, first_;
  std::string suffix_;
};

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
  const std::string what = unreached(record);
  return fmt::format("{}\n{}lengths in m, radiosity in {}{}\ngroups: {}\nmaterials: {}\n", version_text(),
                     what.empty() ? "" : what + "\n", unit_names(record.scene.units).exitance,
                     record.options.thermal
                         ? fmt::format(", temperature in {}", name_of(record.scene.temperature_unit))
                         : "",
                     numbered(record.scene.groups), numbered(materials));
}

}  // namespace

void write_solution_vtu(const std::filesystem::path& file, const RunRecord& record) {
  const ShownMesh shown = shown_mesh(record);
  const ElementView& mesh = shown.mesh;
  std::vector<CellArray> cells;
  SideArrays(record, shown, false).add_to(cells);
  if (shown.unknowns.two_sided) SideArrays(record, shown, true).add_to(cells);
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
  fields.push_back({"reached", unreached(record).empty() ? 1.0 : 0.0});
  write_vtu(file, indexed_mesh(file_elements(record.scene, mesh).outlines), cells, fields, about(record));
}

}  // namespace fluxel

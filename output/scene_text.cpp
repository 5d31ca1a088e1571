#include "output/scene_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "core/option_names.hpp"
#include "core/units.hpp"
#include "output/scene_summary.hpp"
#include "scene/doubts.hpp"
#include "scene/list_names.hpp"
#include "scene/quantity_names.hpp"
#include "scene/readers/doubtful_unit.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kNameWidth = 32;

/// One number where the colours are equal.
std::string rgb_text(const Rgb& c) {
  if (c.r == c.g && c.g == c.b) return fmt::format("{:.4g}", c.r);
  return fmt::format("{:.4g} {:.4g} {:.4g}", c.r, c.g, c.b);
}

std::string vector_text(const glm::dvec3& v) { return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z); }

class SceneText {
 public:
  SceneText(const SceneInput& input, const Scene& scene, const LuminaireDoubts& luminaires)
      : input_(input),
        scene_(scene),
        luminaires_(luminaires),
        units_(unit_names(input.units.value_or(Units::radiometric))) {}

  [[nodiscard]] std::string text() {
    line("scene: {}", scene_.name);
    add_files();
    add_size();
    add_faces();
    add_materials();
    add_luminaires();
    add_cameras();
    add_receivers();
    add_tasks();
    std::vector<std::string> notes = scene_.notes;
    if (luminaires_.note) notes.push_back(*luminaires_.note);
    add_list("notes", notes);
    add_doubts();
    text_.pop_back();  // the last line's end
    return std::move(text_);
  }

 private:
  template <class... Args>
  void line(fmt::format_string<Args...> form, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void add_list(const char* title, const std::vector<std::string>& sentences) {
    if (sentences.empty()) return;
    line("\n{}:", title);
    for (const std::string& sentence : sentences) line("  {}", sentence);
  }

  void add_files() {
    std::vector<std::string> files;  // one may be placed several times
    for (const std::filesystem::path& file : input_.files)
      if (std::ranges::find(files, file.string()) == files.end()) files.push_back(file.string());
    add_list("files", files);
  }

  void add_size() {
    const auto [low, high] = summarise(scene_).bounds;
    const glm::dvec3 size = high - low;
    line("\nsize");
    line("  bounds       {} to {} m", vector_text(low), vector_text(high));
    line("  extent       {:.4g} x {:.4g} x {:.4g} m", size.x, size.y, size.z);
    std::string last;
    for (const InputGeometry& geometry : input_.geometry) {
      const std::string unit = fmt::format("{:g} m of {}{}", geometry.metres_per_unit, geometry.file.string(),
                                           geometry.unit_given ? "" : " (none was given)");
      if (unit != last) line("  unit         {}", unit);  // shapes of a scene file are in one
      last = unit;
    }
    line("  quantities   {} in {}",
         input_.units == Units::photometric ? "photometric: flux" : "radiometric: power", units_.flux);
  }

  void add_faces() {
    const SceneStatistics& of = scene_.statistics;
    line("\nsurfaces");
    line("  faces        {}: {} dropped, {} not planar", of.faces_read, of.degenerate_faces,
         of.nonplanar_faces);
    line("  patches      {}, after {} were merged; {} are cut, into {} pieces in all", scene_.patches.size(),
         of.merged_patches, of.cut_patches, scene_.pieces.size());
    line("  components   {}, {} of them closed; the scene is {}{}", of.components, of.closed_components,
         of.closed ? "closed" : "open", of.convex ? " and convex" : "");
    line("  edges        {} free, {} of more than two patches, {} flipped", of.boundary_edges,
         of.nonmanifold_edges, of.flipped_edges);
    line("  overlaps     {} pairs in one plane, {:.4g} m2 covered", of.coplanar_overlaps, of.covered_area);
    line("  sealed       {} sides that no light reaches", of.sealed_sides);
    line("  groups       {}: {}", scene_.groups.size(), list_names(scene_.groups));
  }

  [[nodiscard]] std::string heat_text(const Material& material) const {
    if (!material.thermal) return {};
    const ThermalSurface& of = *material.thermal;
    const auto temperature = [&](double kelvin) {
      return fmt::format("{:.6g} {}", in_unit(kelvin, scene_.temperature_unit),
                         symbol_of(scene_.temperature_unit));
    };
    std::string text = fmt::format("  emissivity {:.4g}", of.emissivity.points.front().emissivity);
    if (!of.emissivity.is_constant())
      text += fmt::format(" to {:.4g}", of.emissivity.points.back().emissivity);
    if (of.temperature) return text + ", " + temperature(*of.temperature);
    text += fmt::format(", {:.6g} W/m2", of.heat_flux);
    if (of.has_convection())
      text += fmt::format(", {:.4g} W/(m2 K) to air of {}", of.convection_coefficient,
                          temperature(of.air_temperature));
    return text;
  }

  void add_materials() {
    const std::vector<MaterialUse> uses = use_of_materials(scene_);
    std::size_t width = 8;
    for (const Material& material : scene_.materials)
      width = std::max(width, std::min(material.name.size(), kNameWidth));
    Rgb emitted{0};
    line("\n{:{}}  {:>20}  {:>20}  {:5}  {:>8}  {:>10}  {:>20}", "material", width + 2, "reflectance",
         fmt::format("E {}", units_.exitance), "sides", "patches", "area m2",
         fmt::format("emits {}", units_.flux));
    for (std::size_t k = 0; k < uses.size(); ++k) {
      const Material& material = scene_.materials[k];
      const MaterialUse& use = uses[k];
      emitted += use.emitted_power;
      line("  {:{}.{}}  {:>20}  {:>20}  {:5}  {:>8}  {:>10.5g}  {:>20}{}", material.name, width, kNameWidth,
           rgb_text(material.rho), rgb_text(material.E), material.sides == Sides::one ? "one" : "two",
           use.patches, use.area, rgb_text(use.emitted_power), heat_text(material));
    }
    line("  all surfaces emit {} {}", rgb_text(emitted), units_.flux);
  }

  void add_luminaires() {
    if (input_.luminaires.empty()) return;
    Rgb emitted{0};
    line("\nluminaires");
    for (const Luminaire& luminaire : input_.luminaires) {
      const Rgb power = flux(input_.intensities[luminaire.intensity]) * luminaire.scale;
      emitted += power;
      line("  {:{}}  {} {} at {}", luminaire.name, kNameWidth, rgb_text(power), units_.flux,
           vector_text(luminaire.position));
    }
    line("  all luminaires emit {} {}", rgb_text(emitted), units_.flux);
  }

  void add_cameras() {
    if (input_.cameras.empty()) return;
    line("\ncameras");
    for (const InputCamera& camera : input_.cameras) {
      const auto place = [](const auto& given) { return given ? vector_text(given->value) : "?"; };
      line("  {:{}}  from {} to {}", camera.name ? camera.name->value : "(no name)", kNameWidth,
           place(camera.eye), place(camera.look_at));
    }
  }

  void add_receivers() {
    if (input_.receivers.empty()) return;
    line("\nreceivers");
    for (const Receiver& receiver : input_.receivers)
      line("  {:{}}  {}, {} at {}", receiver.name, kNameWidth, name_of(kQuantityNames, receiver.quantity),
           receiver.is_grid() ? fmt::format("{}x{} cells", receiver.columns, receiver.rows)
                              : fmt::format("{} points", receiver.points.size()),
           vector_text(receiver.is_grid() ? receiver.origin : receiver.points.front()));
  }

  void add_tasks() {
    if (!input_.observers.empty()) line("\nobservers");
    for (const Observer& of : input_.observers)
      line("  {:{}}  at {}, looking along {}", of.name, kNameWidth, vector_text(of.eye),
           vector_text(of.direction));
    if (!input_.tasks.empty()) line("\ntasks");
    for (const LightingTask& of : input_.tasks)
      line("  {:{}}  {:g} lx{}{}, of {}", of.name, kNameWidth, of.illuminance,
           of.U0 ? fmt::format(", U0 {:g}", *of.U0) : "", of.UGR ? fmt::format(", UGR {:g}", *of.UGR) : "",
           of.area);
  }

  void add_doubts() {
    std::vector<std::string> doubts = doubts_of(scene_);
    if (const std::optional<std::string> unit = doubt_of_unit(input_)) doubts.insert(doubts.begin(), *unit);
    doubts.insert(doubts.end(), luminaires_.warnings.begin(), luminaires_.warnings.end());
    add_list("suspicious", doubts);
  }

  const SceneInput& input_;
  const Scene& scene_;
  const LuminaireDoubts& luminaires_;
  UnitNames units_;
  std::string text_;
};

}  // namespace

std::string scene_text(const SceneInput& input, const Scene& scene, const LuminaireDoubts& luminaires) {
  return SceneText(input, scene, luminaires).text();
}

}  // namespace fluxel

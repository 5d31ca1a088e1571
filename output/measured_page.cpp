#include "output/measured_page.hpp"

#include <span>

#include "core/luminance.hpp"
#include "core/options.hpp"
#include "image/png_writer.hpp"
#include "image/shrink.hpp"
#include "output/element_mesh_to_show.hpp"
#include "output/html/html_page.hpp"
#include "output/outcome.hpp"
#include "output/run_page.hpp"

namespace fluxel {

namespace {

/// Fronts, then backs where there are any.
void add_sensors(const std::vector<SensorEstimate>& sensors, std::size_t count, const std::string& name,
                 MeshToShow& shown) {
  std::vector<Rgb> means;
  means.reserve(sensors.size());
  for (const SensorEstimate& sensor : sensors) means.push_back(sensor.mean);
  shown.layers.push_back(layer_of(name, std::span(means).first(count)));
  if (means.size() > count) shown.layers.push_back(layer_of(name + "_back", std::span(means).subspan(count)));
}

void add_errors(const std::vector<SensorEstimate>& sensors, std::size_t count, const char* unit,
                MeshToShow& shown) {
  for (std::size_t first = 0; first < sensors.size(); first += count) {
    MeshLayer layer{first == 0 ? "error" : "error_back", 1, {}};
    for (std::size_t k = first; k < first + count; ++k)
      layer.values.push_back(static_cast<float>(luminance(sensors[k].error)));
    shown.layers.push_back(std::move(layer));
  }
  shown.error_is = "standard error of B";
  shown.error_unit = unit;
}

nlohmann::ordered_json measured_mesh(const MeasuredRun& run, const Scene& scene, const FileElements& elements,
                                     const SensorLight& light) {
  MeshToShow shown =
      mesh_to_show(scene, elements, run.options.camera ? run.options.camera->up : glm::dvec3(0, 1, 0));
  const std::size_t count = elements.outlines.size();
  add_sensors(light.measured.sensors, count, "radiosity", shown);
  if (!light.irradiance.empty()) add_sensors(light.irradiance, count, "irradiance", shown);
  if (light.knows_each_error)
    add_errors(light.measured.sensors, count, unit_names(scene.units).exitance, shown);
  return shown_mesh(shown);
}

}  // namespace

void write_measured_page(const MeasuredRun& run, const Scene& scene, const FileElements& elements,
                         const Solution& solution, const MeasuredCost& cost, const Json& report) {
  HtmlPage page;
  page.kind = run.stem;
  page.name = scene.name;
  page.command = command_text(run.options.command, static_cast<std::size_t>(cost.ranks));
  page.units = unit_names(scene.units);
  page.report = report;
  for (const SensorLight& light : solution.sensors) {
    if (page.unreached.empty()) page.unreached = unreached(light.measured);
    if (light.kind == Measured::picture)
      page.pictures.push_back({"as it is shown", png_bytes(shrunk(display_of(run, light), kMostPagePixels)),
                               PagePicture::Of::map});
    if (light.kind == Measured::elements && !elements.outlines.empty() && !light.measured.sensors.empty())
      page.mesh = measured_mesh(run, scene, elements, light);
  }
  add_plans(run.options.out, scene.receivers, page.pictures);
  write_html_page(std::filesystem::path(run.options.out) / (run.stem + ".html"), page);
}

}  // namespace fluxel

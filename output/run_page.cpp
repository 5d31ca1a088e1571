#include "output/run_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "core/options.hpp"
#include "core/thermal.hpp"
#include "image/png_writer.hpp"
#include "image/shrink.hpp"
#include "output/element_mesh_to_show.hpp"
#include "output/false_colour_picture.hpp"
#include "output/outcome.hpp"
#include "output/outputs.hpp"
#include "output/receiver_files.hpp"
#include "output/report.hpp"

namespace fluxel {

namespace {

namespace fs = std::filesystem;

MeshLayer temperature_layer(const RunRecord& record, const std::string& name, std::size_t first,
                            std::uint32_t side) {
  const ElementView& mesh = record.solution.subdivided.mesh;
  MeshLayer layer{name, 1, {}};
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    const Element& element = mesh.elements[k];
    const ThermalSurface& surface = *record.scene.materials[index(element.material)].thermal;
    layer.values.push_back(
        (element.sides & side) == 0
            ? std::numeric_limits<float>::quiet_NaN()
            : static_cast<float>(
                  in_unit(temperature_of(black_exitance(surface, record.solution.radiosity->H[first + k].r)),
                          record.scene.temperature_unit)));
  }
  return layer;
}

nlohmann::ordered_json mesh_of(const RunRecord& record) {
  const Solution& solution = record.solution;
  const ElementView& mesh = solution.subdivided.mesh;
  MeshToShow shown = mesh_to_show(record.scene, mesh,
                                  record.options.camera ? record.options.camera->up : glm::dvec3(0, 1, 0));
  const std::size_t count = mesh.elements.size();
  const auto sides = [&](const std::string& name, const std::vector<Rgb>& values) {
    add_sides(mesh, name, std::span(values).first(count), std::span(values).subspan(count), shown);
  };
  sides("radiosity", solution.radiosity->B);
  sides("irradiance", solution.radiosity->H);
  if (record.options.thermal) {
    shown.layers.push_back(temperature_layer(record, "temperature", 0, kFront));
    if (std::ranges::any_of(mesh.elements,
                            [](const Element& element) { return (element.sides & kBack) != 0; }))
      shown.layers.push_back(temperature_layer(record, "temperature_back", count, kBack));
  }
  return shown_mesh(shown);
}

}  // namespace

std::string command_text(const std::string& command, std::size_t ranks) {
  return ranks > 1 ? fmt::format("mpirun -np {} {}", ranks, command) : command;
}

std::vector<PagePicture> shown_pictures(const OutputSource& source) {
  const RunRecord& record = source.record;
  const bool is_heat = record.options.thermal;
  return {{is_heat ? "as the eye of the camera would see what is emitted and reflected" : "as it is shown",
           png_bytes(shrunk(source.picture->display, kMostPagePixels)), PagePicture::Of::camera},
          {is_heat ? "temperature in false colours" : "radiance in false colours",
           png_bytes(shrunk(false_colour_picture(source), kMostPagePixels)), PagePicture::Of::map}};
}

void add_plans(const fs::path& folder, std::span<const Receiver> receivers,
               std::vector<PagePicture>& pictures) {
  for (const Receiver& receiver : receivers) {
    std::ifstream file(folder / (receiver_stem(receiver) + ".png"), std::ios::binary);
    if (!file) continue;  // points have no plan
    pictures.push_back(
        {receiver.name, std::string(std::istreambuf_iterator<char>(file), {}), PagePicture::Of::receiver});
  }
}

void write_run_page(const fs::path& file, const OutputSource& source) {
  const RunRecord& record = source.record;
  const bool is_view = record.options.method == Method::view;
  HtmlPage page;
  page.kind = is_view ? "view" : "solve";
  page.name = record.scene.name;
  page.command = command_text(record.options.command, record.places.size());
  page.unreached = record.solution.end == RunEnd::solution ? unreached(record) : std::string();
  const ErrorOf error = error_of(record.options);
  page.error_of = error == ErrorOf::surfaces  ? "surfaces"
                  : error == ErrorOf::regions ? "regions of the picture"
                                              : "picture";
  page.units = unit_names(record.scene.units);
  page.temperature_unit = symbol_of(record.scene.temperature_unit);
  page.is_dry = record.solution.end == RunEnd::forecast;
  page.report = report_json(source);
  page.pictures = source.shown;
  if (record.solution.end == RunEnd::solution && can_be_written(record.solution)) {
    add_plans(file.parent_path(), record.scene.receivers, page.pictures);
    page.mesh = mesh_of(record);
  }
  write_html_page(file, page);
}

}  // namespace fluxel

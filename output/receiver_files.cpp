#include "output/receiver_files.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

#include "core/file.hpp"
#include "core/luminance.hpp"
#include "core/option_names.hpp"
#include "image/png_writer.hpp"
#include "image/value_map.hpp"
#include "output/csv.hpp"
#include "scene/quantity_names.hpp"

namespace fluxel {

namespace {

std::string figures_text(const ReceiverFigures& figures, const char* unit) {
  std::string text = fmt::format("mean {} {},   min {},   max {}", stated_text(figures.mean), unit,
                                 stated_text(figures.min), stated_text(figures.max));
  if (figures.U0) text += fmt::format(",   U0 {}", stated_text(*figures.U0));
  return text;
}

}  // namespace

std::string receiver_stem(const Receiver& receiver) { return "receiver-" + receiver.name; }

void write_receiver_picture(const std::filesystem::path& folder, const StatedReceiver& of,
                            std::map<std::string, std::string> attributes) {
  if (!of.unreached.empty()) attributes["fluxel.unreached"] = of.unreached;
  // Without halves, which tell the noise of the rays apart: the stated error is more than that.
  LayeredImage image{of.light.columns, of.light.rows, {}};
  for (const SensorEstimate& cell : of.light.measured.sensors) {
    image.layers[""].push_back(cell.mean);
    image.layers["error"].push_back(cell.error);
  }
  write_exr(folder / (receiver_stem(of.receiver) + ".exr"), image, attributes);
}

void write_receiver_map(const std::filesystem::path& folder, const StatedReceiver& of, Units units,
                        const FalseColourScale& scale) {
  const Receiver& receiver = of.receiver;
  if (!receiver.is_grid()) return;
  ValueMap map{receiver.columns, receiver.rows, {}, receiver.name, unit_of(receiver, units), {}, {}};
  map.title = fmt::format("{}: {}", receiver.name, name_of(kQuantityNames, receiver.quantity));
  map.size = {glm::length(receiver.u), glm::length(receiver.v)};
  for (std::size_t k = 0; k < receiver.size(); ++k)
    map.values.push_back(receiver.measures(k) ? luminance(of.light.measured.sensors[k].mean)
                                              : std::numeric_limits<double>::quiet_NaN());
  map.lines = {figures_text(of.figures, map.unit.c_str())};
  if (!of.unreached.empty()) map.lines.push_back(of.unreached);
  write_png(folder / (receiver_stem(receiver) + ".png"),
            draw_value_map(map, choose_scale(map.values, scale)));
}

void write_receiver_table(const std::filesystem::path& file, const Scene& scene,
                          std::span<const StatedReceiver> receivers) {
  std::string text =
      "receiver,quantity,unit,column,row,x_m,y_m,z_m,value,error,value_r,value_g,value_b,error_r,error_g,"
      "error_b,reached\n";
  for (const StatedReceiver& stated : receivers) {
    const Receiver& receiver = stated.receiver;
    const std::vector<SensorEstimate>& cells = stated.light.measured.sensors;
    const auto columns = static_cast<std::size_t>(receiver.columns);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const glm::dvec3 middle = scene.origin + receiver.place(k, 0.5, 0.5);
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{:.9g},{:.9g},{:.9g}",
                     csv_field(receiver.name), name_of(kQuantityNames, receiver.quantity),
                     unit_of(receiver, scene.units), k % columns, k / columns, middle.x, middle.y, middle.z);
      const Rgb mean = cells[k].mean, error = cells[k].error;
      if (receiver.measures(k))
        fmt::format_to(std::back_inserter(text), ",{:.7g},{:.3g},{:.7g},{:.7g},{:.7g},{:.3g},{:.3g},{:.3g}",
                       luminance(mean), luminance(error), mean.r, mean.g, mean.b, error.r, error.g, error.b);
      else
        text += ",,,,,,,,";
      text += stated.unreached.empty() ? ",true\n" : ",false\n";
    }
  }
  write_bytes_atomically(file, text);
}

}  // namespace fluxel

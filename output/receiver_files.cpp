#include "output/receiver_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>

#include "core/file.hpp"
#include "output/csv.hpp"
#include "output/version_text.hpp"

namespace fluxel {

namespace {

/// The error of the solution added to that of the rays.
SensorEstimate with_solution_error(SensorEstimate estimate, double relative) {
  for (int c = 0; c < kChannels; ++c)
    estimate.error[c] = std::hypot(estimate.error[c], relative * estimate.mean[c]);
  return estimate;
}

/// Of the receivers that were gathered, with the errors that are stated of them.
struct ReceiverLight {
  const Receiver& receiver;
  SensorLight light;
};

std::vector<ReceiverLight> receiver_lights(const RunRecord& record) {
  const double relative = record.solution.expected_error.value_or(0);
  std::vector<ReceiverLight> found;
  for (const Receiver& receiver : record.scene.receivers)
    for (const SensorLight& light : record.solution.sensors) {
      if (light.kind != Measured::receivers || light.receiver != receiver.name) continue;
      ReceiverLight& one = found.emplace_back(ReceiverLight{receiver, light});
      for (SensorEstimate& estimate : one.light.measured.sensors)
        estimate = with_solution_error(estimate, relative);
    }
  return found;
}

}  // namespace

LayeredImage layers_of(const SensorLight& light) {
  LayeredImage image{light.columns, light.rows, {}};
  const auto add = [&](const char* name, auto member) {
    std::vector<Rgb>& layer = image.layers[name];
    for (const SensorEstimate& sensor : light.measured.sensors) layer.push_back(sensor.*member);
  };
  add("", &SensorEstimate::mean);
  add("error", &SensorEstimate::error);
  add("half_a", &SensorEstimate::half_a);
  add("half_b", &SensorEstimate::half_b);
  return image;
}

std::string receiver_file(const SensorLight& light) { return "receiver-" + light.receiver + ".exr"; }

void write_receiver_pictures(const std::filesystem::path& folder, const RunRecord& record) {
  for (const auto& [receiver, light] : receiver_lights(record)) {
    LayeredImage image = layers_of(light);
    // Halves tell the noise of the rays apart; the stated error is more than that.
    image.layers.erase("half_a");
    image.layers.erase("half_b");
    write_exr(folder / receiver_file(light), image,
              {{"fluxel.version", version_text()}, {"fluxel.scene", record.options.scene}});
  }
}

void write_receiver_table(const std::filesystem::path& file, const RunRecord& record) {
  std::string text =
      "receiver,column,row,x_m,y_m,z_m,irradiance_r,irradiance_g,irradiance_b,error_r,error_g,error_b\n";
  for (const auto& [receiver, light] : receiver_lights(record)) {
    const auto columns = static_cast<std::size_t>(receiver.columns);
    for (std::size_t k = 0; k < light.measured.sensors.size(); ++k) {
      const std::size_t column = k % columns, row = k / columns;
      const glm::dvec3 centre = record.scene.origin + receiver.origin +
                                (static_cast<double>(column) + 0.5) / receiver.columns * receiver.u +
                                (1 - (static_cast<double>(row) + 0.5) / receiver.rows) * receiver.v;
      const SensorEstimate& of = light.measured.sensors[k];
      fmt::format_to(std::back_inserter(text),
                     "{},{},{},{:.9g},{:.9g},{:.9g},{:.7g},{:.7g},{:.7g},{:.3g},{:.3g},{:.3g}\n",
                     csv_field(receiver.name), column, row, centre.x, centre.y, centre.z, of.mean.r,
                     of.mean.g, of.mean.b, of.error.r, of.error.g, of.error.b);
    }
  }
  write_bytes_atomically(file, text);
}

}  // namespace fluxel

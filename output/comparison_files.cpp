#include "core/options.hpp"
#include "output/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/file.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "metrics/diverging_colours.hpp"
#include "output/comparison_page.hpp"
#include "output/json_parts.hpp"
#include "output/version_text.hpp"

namespace fluxel {

namespace {

Json noise_json(const ColourErrors& e) {
  const NoiseFreeErrors& free = *e.noise_free;
  const double mean_squared = e.mean * e.mean;
  return {{"mean_square_relative", number(free.mean_square / mean_squared)},
          {"mean_square_error_relative", number(free.mean_square_error / mean_squared)},
          {"hidden", free.is_hidden()},
          {"sigma_relative", number(free.sigma() / e.mean)},
          {"sigma_low_relative", number(free.sigma_low() / e.mean)},
          {"sigma_high_relative", number(free.sigma_high() / e.mean)},
          {"sigma_relative_quadratic", number(free.sigma() / e.quadratic_mean)},
          {"deviation_relative", number(free.deviation() / e.mean)},
          {"bias_error_relative", number(free.bias_error / e.mean)},
          {"reference_noise_relative", number(free.reference_noise / e.mean)},
          {"judged_noise_relative", number(free.judged_noise / e.mean)}};
}

Json colour_json(const Comparands& of, const ColourErrors& e) {
  Json json{{"mean", number(e.mean)},
            {"judged_mean", number(e.judged_mean)},
            {"quadratic_mean", number(e.quadratic_mean)},
            {"sigma", number(e.sigma)},
            {"sigma_relative", number(e.sigma / e.mean)},
            {"sigma_relative_quadratic", number(e.sigma / e.quadratic_mean)},
            {"bias_relative", number(e.bias / e.mean)},
            {"deviation_relative", number(e.deviation / e.mean)},
            {"percentile_99_relative", number(e.percentile_99 / e.mean)},
            {"largest_relative", number(e.largest / e.mean)}};
  if (!of.of_elements()) json["relmse"] = number(e.relative_mean_square);
  if (e.noise_free) json["noise_free"] = noise_json(e);
  return json;
}

Json comparison_json(const CompareOptions& options, const Comparands& of, const ComparisonReport& report) {
  Json json{{"version", version_text()},
            {"judged", options.judged},
            {"reference", options.reference},
            {"kind", of.of_elements() ? "elements" : "pixels"}};
  if (of.of_elements()) {
    json["elements"] = of.elements.outlines.size();
    json["sides"] = of.sides();
    json["area_m2"] = of.area();
  } else {
    json["width"] = of.width;
    json["height"] = of.height;
  }
  json["figure"] = number(report.errors.figure());
  json["figure_is"] = report.noise_free() ? "noise_free.sigma_relative" : "sigma_relative";
  json["fail_above"] = options.fail_above ? Json(*options.fail_above) : Json(nullptr);
  json["map_range"] = report.range;
  for (int c = 0; c < kChannels; ++c) {
    const auto& colour = report.errors.colours[static_cast<std::size_t>(c)];
    json["colours"][kColourNames[c]] = colour ? colour_json(of, *colour) : Json(nullptr);
  }
  json["notes"] = comparison_notes(report);
  return without_unknown(json);
}

std::string histogram_text(const ComparisonReport& report) {
  std::string text = "from,to,share_r,share_g,share_b\n";
  for (std::size_t bin = 0; bin < report.histogram.shares.size(); ++bin) {
    text += fmt::format("{:.6g},{:.6g}", report.histogram.begin(bin), report.histogram.begin(bin + 1));
    for (int c = 0; c < kChannels; ++c)
      text += report.errors.colours[static_cast<std::size_t>(c)]
                  ? fmt::format(",{:.6g}", report.histogram.shares[bin][c])
                  : std::string(",");
    text += "\n";
  }
  return text;
}

void write_pixel_maps(const std::filesystem::path& folder, const Comparands& of,
                      const ComparisonReport& report) {
  LayeredImage image{of.width, of.height, {}};
  image.layers[""] = report.relative;
  write_exr(folder / "error.exr", image, {{"fluxel.version", version_text()}});
  write_png(folder / "error.png", error_map(of, report));
}

void write_element_map(const std::filesystem::path& folder, const Comparands& of,
                       const ComparisonReport& report) {
  const std::vector<double> errors = errors_of_elements(of, report);
  write_coloured_elements(
      folder / "error.ply", of.elements, diverging_colours(errors, report.range), "error", errors,
      fmt::format("error over the mean, of all colours together: blue -{0:g}, white 0, red {0:g}",
                  report.range));
}

}  // namespace

void write_comparison(const CompareOptions& options, const Comparands& of, const ComparisonReport& report) {
  const std::filesystem::path folder = options.out;
  const auto remove = [&](const char* name) {
    std::error_code ignored;
    std::filesystem::remove(folder / name, ignored);
  };
  if (of.of_elements()) {
    write_element_map(folder, of, report);
    for (const char* name : {"error.exr", "error.png"}) remove(name);
  } else {
    write_pixel_maps(folder, of, report);
    remove("error.ply");
  }
  write_bytes_atomically(folder / "histogram.csv", histogram_text(report));
  const Json json = comparison_json(options, of, report);
  write_bytes_atomically(folder / "compare.json", json_text(json));
  write_comparison_page(options, of, report, json);
}

}  // namespace fluxel

#include "output/comparison_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "core/options.hpp"
#include "image/png_writer.hpp"
#include "image/shrink.hpp"
#include "metrics/diverging_colours.hpp"
#include "output/html/html_page.hpp"
#include "output/html/shown_mesh.hpp"
#include "output/run_page.hpp"

namespace fluxel {

namespace {

nlohmann::ordered_json compared_mesh(const Comparands& of, const ComparisonReport& report) {
  MeshToShow shown;
  // Far from the world's origin single precision would move them.
  const glm::dvec3 origin = of.elements.outlines.front().corner.front();
  for (const Outline<glm::dvec3>& wide : of.elements.outlines) {
    Outline<glm::vec3> outline;
    outline.corners = wide.corners;
    for (std::size_t c = 0; c < wide.corners; ++c) outline.corner[c] = glm::vec3(wide.corner[c] - origin);
    shown.outlines.push_back(outline);
  }
  for (const PatchId patch : of.elements.patches)
    shown.patch.push_back(static_cast<std::uint32_t>(index(patch)));
  const std::vector<double> errors = errors_of_elements(of, report);
  MeshLayer layer{"error", 1, {}};
  for (const double error : errors) layer.values.push_back(static_cast<float>(100 * error));
  shown.layers.push_back(std::move(layer));
  shown.error_is = "difference over the mean";
  shown.error_unit = "%";
  shown.is_signed = true;
  return shown_mesh(shown);
}

}  // namespace

DisplayPicture error_map(const Comparands& of, const ComparisonReport& report) {
  DisplayPicture display;
  display.width = of.width;
  display.height = of.height;
  display.rgb = diverging_colours(report.overall, report.range);
  return display;
}

std::vector<double> errors_of_elements(const Comparands& of, const ComparisonReport& report) {
  const std::size_t elements = of.elements.outlines.size();
  std::vector<double> errors(report.overall.begin(),
                             report.overall.begin() + static_cast<std::ptrdiff_t>(elements));
  // A face has one colour: that of the side that is further off.
  for (std::size_t i = elements; i < report.overall.size(); ++i)
    if (std::abs(report.overall[i]) > std::abs(errors[i - elements]))
      errors[i - elements] = report.overall[i];
  return errors;
}

void write_comparison_page(const CompareOptions& options, const Comparands& of,
                           const ComparisonReport& report, const Json& json) {
  HtmlPage page;
  page.kind = "compare";
  page.name = std::filesystem::path(options.judged).filename().string() + " and " +
              std::filesystem::path(options.reference).filename().string();
  page.command = options.command;
  page.report = json;
  if (of.of_elements()) {
    page.mesh = compared_mesh(of, report);
  } else {
    page.pictures.push_back(
        {fmt::format("difference over the mean: blue -{0:g} and below, white 0, red {0:g} and above",
                     report.range),
         png_bytes(shrunk(error_map(of, report), kMostPagePixels)), PagePicture::Of::map});
  }
  write_html_page(std::filesystem::path(options.out) / "compare.html", page);
}

}  // namespace fluxel
